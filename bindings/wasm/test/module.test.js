// node --test: the module by itself, and against the program on the same documents.
// FREIFORM names the program, FREIFORM_WASM the folder of the modules.
import assert from 'node:assert';
import { execFileSync, spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { filesNamedIn, load } from '../freiform.js';
import { difference, questions, tests } from './cases.js';

const root = new URL('../../../', import.meta.url).pathname;
const program = process.env.FREIFORM ?? join(root, 'build-dev/bin/freiform');
const modules = process.env.FREIFORM_WASM ?? join(root, 'build-wasm/bin');
const ff = await load(pathToFileURL(join(modules, 'freiform.packed')));

for (const [name, run] of Object.entries(tests)) test(name, () => run(ff));

test('the module is small', () => {
  const size = (folder, name) => gzipSync(readFileSync(join(folder, name)), { level: 9 }).length;
  const scripts = ['freiform.js', 'unpack.js'].reduce((sum, name) => sum + size(join(root, 'bindings/wasm'), name), 0);
  const all = size(modules, 'freiform.packed') + scripts, curves = size(modules, 'freiform-curves.packed') + scripts;
  console.log(`with scripts, gzipped: everything ${all} bytes, curves and surfaces alone ${curves}`);
  assert(all < 1e6 && curves < 2e5, `${all} and ${curves}`);
});

// A list of commands that is longer than any memory: the C++ library ends the module.
test('the C++ library says why it ends', () => {
  const module = new WebAssembly.Module(readFileSync(join(modules, 'freiform.wasm'))), imports = {};
  let memory, said = '';
  for (const { module: from, name } of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = () => 0;
  imports.wasi_snapshot_preview1.fd_write = (_fd, list, count, written) => {
    const view = new DataView(memory.buffer), [at, size] = [0, 4].map((k) => view.getUint32(list + k, true));
    said += Buffer.from(memory.buffer, at, size);
    view.setUint32(written, size, true);
    return 0;
  };
  const { exports } = new WebAssembly.Instance(module, imports);
  memory = exports.memory;
  exports._initialize();
  assert.throws(() => exports.ff_command(0, -1), WebAssembly.RuntimeError);
  assert.match(said, /^length_error was thrown .* "basic_string"$/);
});

test('shapes alone have values and nearest points, and no commands', async () => {
  const small = await load(readFileSync(join(modules, 'freiform-curves.wasm')));
  const names = Object.keys(tests).filter((n) => /curve is evaluated|says what it is|dragging|grid|basis|nearest|memory/.test(n));
  assert.equal(names.length, 7);
  for (const name of names) tests[name](small);
  assert.throws(() => small.run('info', { type: 'curve', points: [[0], [1]] }), { kind: 'unavailable' });
});

// STEP files: the module has the reader that the program has. ----------------------------------------------------------

const bracket = readFileSync(join(root, 'examples/bracket.step'), 'utf8');
// One of its surfaces is of a kind that no reader knows.
const odd = bracket.replace('TOROIDAL_SURFACE(', 'WRINKLED_SURFACE(');

// The area of the triangles of a binary STL file.
function area(stl) {
  let sum = 0;
  for (let at = 96; at < stl.length; at += 50) {
    const x = (corner, k) => stl.readFloatLE(at + 12 * corner + 4 * k);
    const a = [0, 1, 2].map((k) => x(1, k) - x(0, k)), b = [0, 1, 2].map((k) => x(2, k) - x(0, k));
    sum += Math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]) / 2;
  }
  return sum;
}

test('a STEP model is read, meshed and measured without a program', () => {
  const { shapes: [model], unit } = ff.document({ file: 'bracket.step', content: bracket });
  assert.equal(model.type, 'model');
  assert.equal(unit, 'mm');
  const mesh = model.mesh({ tolerance: 0.1 });
  assert.equal(mesh.parts.length, 24);
  assert.equal(mesh.openEdges, 0);
  assert.deepEqual(mesh.refused, []);
  assert(mesh.errorBound > 0 && mesh.errorBound <= 0.1);
  model.free();
  const { shapes: [rest] } = ff.document({ file: 'odd.step', content: odd });
  const { parts, refused: [refused, ...others] } = rest.mesh({ tolerance: 0.1 });
  assert.equal(parts.length, 23);
  assert.equal(others.length, 0);
  assert.equal(refused.kind, 'unsupported');
  assert.match(refused.where, /^#\d+ ADVANCED_FACE/);
  assert.match(refused.message, /WRINKLED_SURFACE/);
  rest.free();
  // What can be meshed is delivered, with what was refused.
  const { bytes, report, remarks } = ff.run('tessellate', { file: 'odd.step', content: odd }, { to: 'ply', tolerance: 0.1 });
  assert.match(new TextDecoder().decode(bytes.slice(0, 4)), /^ply/);
  assert.equal(report.refused.length, 1);
  assert(remarks.some((line) => line.includes('without one face that was refused')), remarks.join());
  assert.throws(() => ff.document({ file: 'half.step', content: bracket.slice(0, 60000) }), { kind: 'unreadable' });
});

test('parts of a STEP assembly may be in files that come with it', () => {
  const content = readFileSync(new URL('../../../tests/fuzz/seeds/step/documents.stp', import.meta.url));
  assert.deepEqual(filesNamedIn(content), ['a.stp', 'sub/b.stp', 'b.stp']);
  assert.deepEqual(filesNamedIn("#1=DOCUMENT_FILE ('C:\\\\x\\\\p.stp','');"), ['p.stp']);
  const beside = { 'a.stp': bracket, 'B.STP': bracket };
  for (const folder of ['', 'some/']) {
    const { shapes: [whole], leftOut } = ff.document({ file: `${folder}all.stp`, content, beside });
    assert.deepEqual(leftOut, []);
    const { parts, refused } = whole.mesh({ tolerance: 1 });
    assert.equal(parts.length, 2 * 24 + 1);
    assert.deepEqual(refused, []);
    whole.free();
    // Nothing of them stays.
    const { shapes: [alone] } = ff.document({ file: `${folder}all.stp`, content });
    assert.equal(alone.json().refused.length, 2);
    alone.free();
    assert.equal(ff.run('info', { file: `${folder}all.stp`, content, beside }).json.objects[0].faces, 2 * 24 + 1);
  }
});

test('answers about STEP files are those of the program', { skip: !existsSync(program) && `${program} is not built` }, () => {
  const place = mkdtempSync(join(tmpdir(), 'freiform-step-'));
  try {
    for (const [name, content] of [['bracket.step', bracket], ['odd.step', odd]]) {
      writeFileSync(join(place, name), content);
      const both = (...args) => {
        const words = [...args, '--reader', 'freiform', '--json'];
        const theirs = spawnSync(program, words, { cwd: place, env: { ...process.env, FREIFORM_ISA: 'base' }, maxBuffer: 1 << 28 });
        const ours = ff.command(words, { [name]: content });
        assert.equal(ours.code, args[0] === 'tessellate' && name === 'odd.step' ? 1 : 0, ours.stderr);
        assert.equal(ours.code, theirs.status, theirs.stderr.toString());
        return [JSON.parse(theirs.stdout), JSON.parse(Buffer.from(ours.stdout)), ours.files];
      };
      const [a, b] = both('info', name);
      assert.equal(b.objects[0].faces, name === 'odd.step' ? 23 : 24);
      for (const key of ['faces', 'edges', 'vertices', 'open_edges', 'face_kinds', 'edge_kinds', 'refused'])
        assert.deepEqual(b.objects[0][key], a.objects[0][key], key);
      const [there, here, { 'out.stl': stl }] = both('tessellate', name, '--tolerance', '0.1', '-o', 'out.stl');
      for (const key of ['triangles', 'vertices', 'faces', 'open_edges', 'refused']) assert.deepEqual(here[key], there[key], key);
      assert(Math.abs(here.error_bound / there.error_bound - 1) < 1e-6, `${here.error_bound} and ${there.error_bound}`);
      const sizes = [area(readFileSync(join(place, 'out.stl'))), area(Buffer.from(stl))];
      assert(sizes[0] > 0 && Math.abs(sizes[1] / sizes[0] - 1) < 1e-6, sizes.join(' and '));
    }
  } finally {
    rmSync(place, { recursive: true });
  }
});

// The same questions to the program.
const folder = join(root, 'examples/gallery');
const documents = readdirSync(folder).filter((f) => f.endsWith('.json')).map((f) => join(folder, f));
const most = Number(process.env.FREIFORM_DOCUMENTS ?? 12);
for (const file of [join(root, 'examples/curves.json'), join(root, 'examples/badge.svg'), ...documents].slice(0, most))
  test(`answers about ${basename(file)} are those of the program`, { skip: !existsSync(program) && `${program} is not built` }, () => {
    const name = basename(file), content = readFileSync(file);
    for (const [command, ...options] of questions) {
      const args = [command, name, ...options];
      let code = 0, stdout;
      try {
        stdout = execFileSync(program, args, { cwd: join(file, '..'), stdio: ['ignore', 'pipe', 'ignore'], maxBuffer: 1 << 28 });
      } catch (error) {
        ({ status: code, stdout } = error);
      }
      const ours = ff.command(args, { [name]: content });
      assert.equal(ours.code, code, `${args.join(' ')}: ${ours.stderr}`);
      if (stdout.length === 0) continue;
      assert.equal(difference(JSON.parse(stdout), JSON.parse(Buffer.from(ours.stdout))), null, args.join(' '));
    }
  });
