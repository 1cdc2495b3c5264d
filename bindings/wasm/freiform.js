// freiform for node and browsers; freiform.d.ts describes all that is exported.
//
// One instance of the module holds the shapes, a second one runs commands: what a command breaks, no shape notices. Both
// are made while `load` is awaited: browsers refuse to make one of a large module at once in a page. A refusal leaves
// the module as an exception of the function `refuse` that it imports, so the stack pointer is put back by hand.

import { Damaged, isPacked, unpack } from './unpack.js';

export class FreiformError extends Error {
  constructor(kind, where, message) {
    super(where ? `${where}: ${message}` : message);
    this.name = 'FreiformError';
    this.kind = kind;
    this.where = where;
    this.reason = message;
  }
}

const utf8 = new TextEncoder();
const text = new TextDecoder();
const kNoSuchFunction = 52, kPages = 65536;

// What the C library asks of its surroundings: a clock, random numbers, and where its last words go.
function surroundings(memory, say) {
  const view = () => new DataView(memory().buffer);
  const zero = (...at) => (at.forEach((a) => view().setUint32(a, 0, true)), 0);
  return {
    clock_time_get: (_id, _precision, at) => {
      view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return 0;
    },
    random_get: (at, size) => {
      for (let done = 0; done < size; done += kPages)
        crypto.getRandomValues(new Uint8Array(memory().buffer, at + done, Math.min(kPages, size - done)));
      return 0;
    },
    environ_sizes_get: (count, size) => zero(count, size),
    environ_get: () => 0,
    fd_write: (_fd, list, count, written) => {
      let size = 0;
      for (let i = 0; i < count; ++i) {
        const at = view().getUint32(list + 8 * i, true), n = view().getUint32(list + 8 * i + 4, true);
        say(text.decode(new Uint8Array(memory().buffer, at, n)));
        size += n;
      }
      view().setUint32(written, size, true);
      return 0;
    },
    proc_exit: (code) => { throw new FreiformError('crash', '', `the module ended with code ${code}`); },
  };
}

class Instance {
  static async make(module) {
    const it = new Instance();
    return it.#begin(await WebAssembly.instantiate(module, it.#imports(module)));
  }
  // At once: in a page only where the module is small (in Chromium up to 8 MB).
  static now(module) {
    const it = new Instance();
    return it.#begin(new WebAssembly.Instance(module, it.#imports(module)));
  }

  constructor() {
    this.lastWords = '';
    this.dead = false;
  }

  #imports(module) {
    const memory = () => this.exports.memory;
    const wasi = surroundings(memory, (s) => { this.lastWords += s; });
    const imports = { wasi_snapshot_preview1: {}, freiform: {
      refuse: (kind, kindSize, where, whereSize, message, messageSize) => {
        throw new FreiformError(this.string(kind, kindSize), this.string(where, whereSize), this.string(message, messageSize));
      },
      digits: (x, at) => {
        const s = x.toExponential(), bytes = this.#bytes();
        for (let i = 0; i < s.length; ++i) bytes[at + i] = s.charCodeAt(i);
        return s.length;
      },
      number: (at, size) => Number(this.string(at, size)),
      progress: (part) => (this.progress && this.progress(part) === false ? 0 : 1),
    } };
    for (const { module: from, name } of WebAssembly.Module.imports(module))
      if (from === 'wasi_snapshot_preview1') imports[from][name] = wasi[name] ?? (() => kNoSuchFunction);
    return imports;
  }

  #begin({ exports }) {
    this.exports = exports;
    exports._initialize();
    exports.ff_start();
    return this;
  }

  // All memory; its buffer is another one when it has grown.
  #bytes() {
    if (this.view?.buffer !== this.exports.memory.buffer) this.view = new Uint8Array(this.exports.memory.buffer);
    return this.view;
  }

  string(at, size) { return text.decode(this.#bytes().subarray(at, at + size)); }

  // Calls ff_NAME; whatever goes wrong becomes a FreiformError.
  call(name, ...values) {
    if (this.dead) throw new FreiformError('crash', '', 'the module has crashed before: load it again');
    const stack = this.exports.__stack_pointer;
    const before = stack.value;
    try {
      return this.exports[`ff_${name}`](...values);
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) {
        this.dead = true;
        throw new FreiformError('crash', '', `${error.message} ${this.lastWords}`.trim());
      }
      stack.value = before;
      throw error;
    }
  }

  // f with addresses of copies of the arrays, freed afterwards: `null` is 0, a number n room for n doubles.
  with(arrays, f) {
    const at = [];
    try {
      for (const a of arrays)
        at.push(a === null ? 0 : this.call('allocate', Math.max(8, typeof a === 'number' ? 8 * a : a.byteLength)));
      arrays.forEach((a, i) => {
        if (a !== null && typeof a !== 'number')
          new Uint8Array(this.exports.memory.buffer, at[i], a.byteLength)
            .set(new Uint8Array(a.buffer, a.byteOffset, a.byteLength));
      });
      return f(...at);
    } finally {
      if (!this.dead) for (const a of at) if (a !== 0) this.call('release', a);
    }
  }

  // A file for what is called next.
  put(name, bytes) {
    const named = utf8.encode(name);
    this.with([named, bytes], (at, from) => this.call('put_file', at, named.length, from, bytes.length));
  }

  // `out`, or a new array, with the numbers at an address.
  fill(out, at, count) {
    if (!out) return this.copy(Float64Array, at, count);
    out.set(new Float64Array(this.exports.memory.buffer, at, count));
    return out;
  }
  copy(Type, at, count) { return new Type(this.exports.memory.buffer, at, count).slice(); }
  reply() { return this.string(this.call('text'), this.call('text_size')); }
  replyBytes() { return this.copy(Uint8Array, this.call('text'), this.call('text_size')); }
  numbers() { return this.copy(Float64Array, this.call('numbers'), this.call('numbers_size')); }
  floats() { return this.copy(Float32Array, this.call('floats'), this.call('floats_size')); }
  indices() { return this.copy(Uint32Array, this.call('indices'), this.call('indices_size')); }
}

const doubles = (a) => (a instanceof Float64Array ? a : Float64Array.from(a));
function checkRoom(out, count, where) {
  if (out && out.length !== count)
    throw new FreiformError('usage', where, `has room for ${out.length} numbers, ${count} were expected`);
}
const product = (numbers) => numbers.reduce((a, b) => a * b, 1);

// Partial derivatives of n variables up to order k.
function jetSize(n, k) {
  let size = 1;
  for (let i = 1; i <= n; ++i) size = (size * (k + i)) / i;
  return size;
}

class Shape {
  #module; #handle; #facts; #json;
  constructor(module, handle) {
    this.#module = module;
    this.#handle = handle;
    module.registry?.register(this, handle, this);
  }

  get handle() {
    if (this.#handle < 0) throw new FreiformError('usage', '', 'the shape has been freed');
    return this.#handle;
  }
  get #instance() { return this.#module.instance; }
  get #about() {
    if (this.#facts) return this.#facts;
    this.#instance.call('describe', this.handle);
    const facts = JSON.parse(this.#instance.reply());
    const numbers = this.#instance.numbers();
    let from = 0;
    const take = (n) => numbers.slice(from, (from += n));
    const count = facts.parameters === 0 ? 0 : product(facts.size);
    facts.knots = facts.knots.map(take);
    facts.points = take(count * facts.dimension);
    facts.weights = take(count);
    facts.rational = facts.rational === 1;
    facts.closed = facts.closed.map((c) => c === 1);
    return (this.#facts = facts);
  }
  get name() { return this.#about.name; }
  get type() { return this.#about.type; }
  get parameters() { return this.#about.parameters; }
  get dimension() { return this.#about.dimension; }
  get rational() { return this.#about.rational; }
  get degrees() { return this.#about.degrees; }
  get size() { return this.#about.size; }
  get knots() { return this.#about.knots; }
  get closed() { return this.#about.closed; }
  get domain() { return this.#about.domain; }
  get points() { return this.#about.points; }
  get weights() { return this.#about.weights; }
  get valueErrorBound() { return this.#instance.call('error_bound', this.handle); }

  json() { return (this.#json ??= this.#module.json([this]).objects[0]); }

  free() {
    if (this.#handle < 0) return;
    this.#module.registry?.unregister(this);
    if (!this.#instance.dead) this.#instance.call('free', this.#handle);
    this.#handle = -1;
  }

  with(points, weights = []) {
    const p = doubles(points), w = doubles(weights);
    const handle = this.#instance.with([p, w], (at, of) =>
      this.#instance.call('with', this.handle, at, p.length, of, w.length));
    return new Shape(this.#module, handle);
  }

  evaluate(at, { derivatives = 0, out } = {}) {
    const u = doubles(at);
    const n = Math.max(1, this.parameters);
    if (u.length % n !== 0)
      throw new FreiformError('invalid', 'at', `has ${u.length} numbers, the shape has ${n} parameters`);
    if (!Number.isInteger(derivatives) || derivatives < 0)
      throw new FreiformError('usage', 'derivatives', 'an order from 0 was expected');
    const count = u.length / n, size = count * this.dimension * jetSize(n, derivatives);
    checkRoom(out, size, 'out');
    return this.#instance.with([u, size], (from, to) => {
      this.#instance.call('evaluate', this.handle, from, count, derivatives, to);
      return this.#instance.fill(out, to, size);
    });
  }

  grid(axes, { normals = false, curvatures = false, out = {} } = {}) {
    const all = axes.map(doubles), sizes = Uint32Array.from(all, (a) => a.length);
    const flat = new Float64Array(all.reduce((n, a) => n + a.length, 0));
    all.reduce((from, a) => (flat.set(a, from), from + a.length), 0);
    const count = product([...sizes]);
    checkRoom(out.points, count * this.dimension, 'out.points');
    checkRoom(out.normals, 3 * count, 'out.normals');
    return this.#instance.with([flat, sizes, count * this.dimension, normals ? 3 * count : null, curvatures ? 2 * count : null],
      (from, of, to, n, c) => {
        this.#instance.call('grid', this.handle, from, of, sizes.length, to, n, c);
        const grid = { points: this.#instance.fill(out.points, to, count * this.dimension) };
        if (normals) grid.normals = this.#instance.fill(out.normals, n, 3 * count);
        if (curvatures) {
          const pairs = this.#instance.copy(Float64Array, c, 2 * count);
          grid.gauss = pairs.filter((_, i) => i % 2 === 0);
          grid.mean = pairs.filter((_, i) => i % 2 === 1);
        }
        return grid;
      });
  }

  basis(at, { axis = 0, order = 0 } = {}) {
    const u = doubles(at), size = u.length * (this.size[axis] ?? 0);
    return this.#instance.with([u, size], (from, to) => {
      this.#instance.call('basis', this.handle, axis, from, u.length, order, to);
      return this.#instance.copy(Float64Array, to, size);
    });
  }

  construction(at) {
    const parameters = typeof at === 'number' ? [at] : Array.from(at);
    const [answer] = this.#module.run('eval', this.json(), { at: [parameters], construction: true }).json.results;
    return { levels: answer.construction, bound: answer.construction_bound };
  }

  nearest(points, { accuracy = 0 } = {}) {
    const p = doubles(points), dimension = this.dimension;
    const numbers = this.#instance.with([p], (from) => {
      this.#instance.call('nearest', this.handle, from, p.length, accuracy);
      return this.#instance.numbers();
    });
    const isModel = this.type === 'model' || this.type === 'trimmed';
    const parameters = isModel ? 2 : this.parameters;
    const row = (isModel ? 1 : 0) + parameters + dimension + 2, count = numbers.length / row;
    const columns = (from, n) =>
      Float64Array.from({ length: count * n }, (_, i) => numbers[Math.floor(i / n) * row + from + (i % n)]);
    const first = isModel ? 1 : 0;
    const answer = {
      parameters: columns(first, parameters),
      points: columns(first + parameters, dimension),
      distances: columns(first + parameters + dimension, 1),
      lowerBounds: columns(first + parameters + dimension + 1, 1),
    };
    if (isModel) answer.faces = Int32Array.from(columns(0, 1));
    return answer;
  }

  mesh({ tolerance, maxEdge = 0, maxAngle = 0, quads = false, maxTriangles = 0, progress }) {
    const instance = this.#instance;
    instance.progress = progress;
    try {
      instance.call('mesh', this.handle, tolerance, maxEdge, maxAngle, quads ? 1 : 0, maxTriangles);
    } finally {
      instance.progress = undefined;
    }
    const floats = instance.floats(), half = floats.length / 2;
    return {
      positions: floats.slice(0, half), normals: floats.slice(half), uvs: instance.numbers(), indices: instance.indices(),
      ...JSON.parse(instance.reply()),
    };
  }

  polylines(tolerance) {
    const lines = this.#module.run('flatten', this.json(), { tolerance }).json.objects;
    return lines.map((line) => ({
      points: Float64Array.from(line.points.flat()),
      parameters: Float64Array.from(line.parameters),
      bound: line.error_bound,
    }));
  }
}

// Inputs and options of commands

const isBytes = (x) => x instanceof Uint8Array;
const isList = (x) => Array.isArray(x) || (ArrayBuffer.isView(x) && !(x instanceof DataView) && !isBytes(x));
const isNamedFile = (x) => typeof x === 'object' && x !== null && typeof x.file === 'string' && 'content' in x;
const isWord = (x) => typeof x === 'string' && x.length <= 200 && !/[\n{[<]/.test(x);
const asBytes = (x) => (isBytes(x) ? x : utf8.encode(x));
const kebab = (name) => '--' + name.replace(/[A-Z]/g, (c) => '-' + c.toLowerCase());

// The name and bytes of a source that is no word, and those of files beside it.
function fileOf(source, number) {
  if (source instanceof Shape) return fileOf(source.json(), number);
  if (isNamedFile(source)) {
    const folder = source.file.slice(0, source.file.lastIndexOf('/') + 1);
    return [source.file, asBytes(source.content), Object.entries(source.beside ?? {}).map(([path, content]) => [folder + path, asBytes(content)])];
  }
  if (isBytes(source) || typeof source === 'string') return [`input${number}`, asBytes(source)];
  return [`input${number}.json`, utf8.encode(JSON.stringify(source))];
}

// Whether the arguments ask for this file to be written, although it was there before.
const wasWritten = (args, name) =>
  args.some((a, i) => (a === '-o' || a === '--output') ? args[i + 1] === name : a === `--output=${name}`);

export function filesNamedIn(content) {
  const written = typeof content === 'string' ? content : new TextDecoder('latin1').decode(content);
  const paths = new Set();
  for (const [, name] of written.matchAll(/(?:DOCUMENT_FILE|EXTERNAL_IDENTIFICATION_ASSIGNMENT)\s*\(\s*'([^']+)'/g)) {
    const path = name.replace(/\\+/g, '/').replace(/^(\.\/)+/, '');
    if (!/^\/|:|\.\./.test(path)) paths.add(path);
    paths.add(path.slice(path.lastIndexOf('/') + 1));
  }
  return [...paths].filter((path) => path !== '');
}

class Freiform {
  #commandInstance; #described;
  constructor(module, instance, commandInstance) {
    this.module = module;
    this.instance = instance;
    this.#commandInstance = commandInstance;
    this.instance.call('about');
    [this.version, this.instructions] = this.instance.reply().split(' ');
    if (typeof FinalizationRegistry !== 'undefined')
      this.registry = new FinalizationRegistry((handle) => { if (!this.instance.dead) this.instance.call('free', handle); });
  }

  get memory() {
    return this.instance.exports.memory.buffer.byteLength + (this.#commandInstance?.exports.memory.buffer.byteLength ?? 0);
  }

  document(source) {
    const [name, bytes, beside = []] = fileOf(source, 0);
    const named = utf8.encode(name);
    try {
      for (const file of beside) this.instance.put(...file);
      return this.instance.with([bytes, named], (at, nameAt) => {
        this.instance.call('document', at, bytes.length, nameAt, named.length);
        const { unit, shapes, left_out: leftOut } = JSON.parse(this.instance.reply());
        return { unit, shapes: shapes.map((handle) => new Shape(this, handle)), leftOut };
      });
    } finally {
      if (beside.length > 0 && !this.instance.dead) this.instance.call('clear_files');
    }
  }

  shape(source) {
    const { shapes } = this.document(source);
    if (shapes.length === 1) return shapes[0];
    for (const s of shapes) s.free();
    throw new FreiformError('invalid', 'objects', `one object was expected, there are ${shapes.length}`);
  }

  json(shapes, unit = '') {
    const handles = Int32Array.from(shapes, (s) => s.handle), named = utf8.encode(unit);
    return this.instance.with([handles, named], (at, unitAt) => {
      this.instance.call('write', at, handles.length, unitAt, named.length);
      return JSON.parse(this.instance.reply());
    });
  }

  // Another instance after a crash.
  #replace() {
    try {
      this.#commandInstance = Instance.now(this.module);
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      Instance.make(this.module).then((made) => { this.#commandInstance = made; }, () => undefined);
      throw new FreiformError('crash', '', 'a command has crashed; the module is being started again for the next');
    }
  }

  get commands() { return (this.#described ??= JSON.parse(text.decode(this.command(['--describe']).stdout))); }

  command(args, files = {}) {
    if (!this.#commandInstance) throw new FreiformError('unavailable', '', 'this module has no commands: load freiform.wasm');
    if (this.#commandInstance.dead) this.#replace();
    const instance = this.#commandInstance;
    instance.call('clear_files');
    for (const [name, content] of Object.entries(files)) instance.put(name, asBytes(content));
    const line = utf8.encode(args.map((a) => a + '\0').join(''));
    let code = 0, stderr = '', stdout;
    try {
      code = instance.with([line], (at) => instance.call('command', at, line.length));
      stderr = instance.reply();
    } catch (error) {
      if (!(error instanceof FreiformError)) throw error;
      code = error.kind === 'usage' ? 2 : 4;
      stderr = `freiform: ${error.message}\n`;
      const { kind, where, reason: message } = error;
      stdout = utf8.encode(args.includes('--json') ? JSON.stringify({ error: { kind, message, where } }) + '\n' : '');
      if (instance.dead) return { code, stdout, stderr, files: {} };
    }
    instance.call('files');
    const made = {};
    for (const name of instance.reply().split('\n').slice(0, -1)) {
      const named = utf8.encode(name);
      instance.with([named], (at) => instance.call('take_file', at, named.length));
      if (name === '-') stdout ??= instance.replyBytes();
      else if (!(name in files) || wasWritten(args, name)) made[name] = instance.replyBytes();
    }
    return { code, stdout: stdout ?? new Uint8Array(), stderr, files: made };
  }

  run(command, inputs = [], options = {}) {
    const files = {};
    const keep = (source) => {
      const [name, bytes, beside = []] = fileOf(source, Object.keys(files).length);
      for (const [path, content] of beside) files[path] ??= content;
      files[name] = bytes;
      return name;
    };
    const known = this.commands.find((c) => c.name === command)?.options ?? [];
    const args = [command];
    const list = Array.isArray(inputs) && !isList(inputs[0]) ? inputs : [inputs];
    for (const input of list) args.push(isWord(input) ? input : keep(input));
    for (const [key, value] of Object.entries(options)) {
      if (value === undefined || value === false || value === null) continue;
      const name = kebab(key);
      if (name === '--to') args.push('--output', `output.${value}`);
      args.push(name);
      if (value === true) continue;
      const wantsFile = known.find((o) => o.name === name)?.value.includes('FILE') && name !== '--output';
      if (isList(value)) {
        const rows = isList(value[0]) ? Array.from(value, (row) => Array.from(row).join(',')) : [Array.from(value).join(',')];
        args.push(wantsFile ? keep({ file: `${key}.csv`, content: rows.join('\n') + '\n' }) : rows.join(';'));
      } else {
        args.push(typeof value === 'object' || (wantsFile && !isWord(value)) ? keep(value) : String(value));
      }
    }
    args.push('--json');
    const { code, stdout, stderr, files: made } = this.command(args, files);
    const said = text.decode(stdout);
    const answer = /^\s*[{[]/.test(said) ? JSON.parse(said) : null;
    if (code !== 0 && (answer?.error || !answer)) {
      const { kind = 'crash', where = '', message = stderr.trim() } = answer?.error ?? {};
      throw new FreiformError(kind, where, message);
    }
    const output = options.to === undefined ? stdout : made[`output.${options.to}`] ?? new Uint8Array();
    const remarks = stderr.split('\n').filter(Boolean).map((line) => line.replace(/^freiform: /, ''));
    return {
      bytes: output, remarks,
      get text() { return text.decode(output); },
      get json() { return options.to === undefined ? answer : JSON.parse(text.decode(output)); },
      report: options.to === undefined ? null : answer,
    };
  }
}

// Loading

function unpackedOf(source) {
  const bytes = ArrayBuffer.isView(source) ? new Uint8Array(source.buffer, source.byteOffset, source.byteLength) : new Uint8Array(source);
  if (!isPacked(bytes)) return source;
  try {
    return unpack(bytes);
  } catch (error) {
    throw error instanceof Damaged ? new FreiformError('unreadable', '', error.message) : error;
  }
}

async function compiled(source) {
  if (source instanceof WebAssembly.Module) return source;
  if (source instanceof ArrayBuffer || ArrayBuffer.isView(source)) return WebAssembly.compile(unpackedOf(source));
  if (typeof source === 'string' || source instanceof URL) {
    const url = new URL(source, import.meta.url);
    if (url.protocol === 'file:' && typeof process !== 'undefined') {
      const { readFile } = await import(/* @vite-ignore */ 'node:fs/promises');
      return compiled(await readFile(url));
    }
    return compiled(await fetch(url));
  }
  const response = await source;
  if (!response.ok) throw new FreiformError('io', response.url, `cannot be fetched: ${response.status}`);
  // While it arrives, where the server says what it is.
  const type = response.headers.get('content-type') ?? '';
  if (type.startsWith('application/wasm') && WebAssembly.compileStreaming) return WebAssembly.compileStreaming(response);
  return compiled(await response.arrayBuffer());
}

const hasCommands = (module) => WebAssembly.Module.exports(module).some(({ name }) => name === 'ff_command');

export async function load(source = new URL('./freiform.packed', import.meta.url)) {
  const module = await compiled(source);
  return new Freiform(module, await Instance.make(module), hasCommands(module) ? await Instance.make(module) : undefined);
}
