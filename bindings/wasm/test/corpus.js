// node corpus.js [--gtest_filter=...]: the C++ tests from core to model, compiled to WebAssembly, in a thread for each processor. The same
// function runs them in a page (browser.js). Exit code 77 where they have not been built:
//     cmake --build --preset wasm --target freiform-tests
const kNoSuchFunction = 52, kNoSuchFile = 8;

class Ended extends Error {
  constructor(code) { super(`ended with ${code}`); this.code = code; }
}

// What the program says, and how it ended; a trap is code 134.
export async function run(module, words = [], environment = {}) {
  let memory, said = '';
  const utf8 = new TextEncoder(), text = new TextDecoder();
  const args = ['tests', ...words].map((w) => utf8.encode(w + '\0'));
  const variables = Object.entries(environment).map(([name, value]) => utf8.encode(`${name}=${value}\0`));
  const view = () => new DataView(memory.buffer);
  const put = (at, ...values) => (values.forEach((v, i) => view().setUint32(at + 4 * i, v, true)), 0);
  const sizes = (list, count, size) => put(count, list.length) || put(size, list.reduce((n, a) => n + a.length, 0));
  const texts = (list, at, to) => {
    for (const [i, a] of list.entries()) {
      put(at + 4 * i, to);
      new Uint8Array(memory.buffer, to, a.length).set(a);
      to += a.length;
    }
    return 0;
  };
  const wasi = {
    args_sizes_get: (count, size) => sizes(args, count, size),
    args_get: (at, to) => texts(args, at, to),
    environ_sizes_get: (count, size) => sizes(variables, count, size),
    environ_get: (at, to) => texts(variables, at, to),
    clock_time_get: (_id, _precision, at) => (view().setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true), 0),
    random_get: (at, size) => (crypto.getRandomValues(new Uint8Array(memory.buffer, at, size)), 0),
    fd_prestat_get: () => kNoSuchFile,
    fd_fdstat_get: (_fd, at) => (new Uint8Array(memory.buffer, at, 24).fill(0), view().setUint8(at, 2), 0),
    fd_close: () => 0,
    fd_write: (_fd, list, count, written) => {
      let size = 0;
      for (let i = 0; i < count; ++i) {
        const n = view().getUint32(list + 8 * i + 4, true);
        said += text.decode(new Uint8Array(memory.buffer, view().getUint32(list + 8 * i, true), n));
        size += n;
      }
      return put(written, size);
    },
    proc_exit: (code) => { throw new Ended(code); },
  };
  const imports = { wasi_snapshot_preview1: {}, freiform: {
    digits: (x, at) => utf8.encodeInto(x.toExponential(), new Uint8Array(memory.buffer, at)).written,
    number: (at, size) => Number(text.decode(new Uint8Array(memory.buffer, at, size))),
  } };
  for (const { module: from, name } of WebAssembly.Module.imports(module))
    if (from === 'wasi_snapshot_preview1') imports.wasi_snapshot_preview1[name] = wasi[name] ?? (() => kNoSuchFunction);
  const { exports } = await WebAssembly.instantiate(module, imports);
  memory = exports.memory;
  let code = 0;
  try {
    exports._start();
  } catch (error) {
    code = error instanceof Ended ? error.code : 134;
    if (code === 134) said += `${error.message}\n`;
  }
  return { code, said, passed: Number(/\[  PASSED  \] (\d+) tests?/.exec(said)?.[1] ?? 0) };
}

if (typeof process !== 'undefined' && process.argv[1] === decodeURIComponent(new URL(import.meta.url).pathname)) {
  const { existsSync, readFileSync } = await import('node:fs');
  const { join } = await import('node:path');
  const folder = process.env.FREIFORM_WASM ?? new URL('../../../build-wasm/bin', import.meta.url).pathname;
  const file = join(folder, 'freiform-tests.wasm');
  if (!existsSync(file)) {
    console.log(`${file} is not built`);
    process.exit(77);
  }
  const { isMainThread, parentPort, workerData, Worker } = await import('node:worker_threads');
  if (!isMainThread) {  // one of `total` parts of the tests
    const { module, words, index, total } = workerData;
    parentPort.postMessage(await run(module, ['--gtest_brief=1', ...words], { GTEST_TOTAL_SHARDS: total, GTEST_SHARD_INDEX: index }));
  } else {
    const module = await WebAssembly.compile(readFileSync(file)), total = (await import('node:os')).cpus().length;
    const parts = await Promise.all(Array.from({ length: total }, (_, index) => new Promise((done, failed) => {
      const worker = new Worker(new URL(import.meta.url), { workerData: { module, words: process.argv.slice(2), index, total } });
      worker.once('message', done).once('error', failed);
    })));
    for (const { said } of parts) process.stdout.write(said);
    console.log(`${parts.reduce((n, p) => n + p.passed, 0)} tests passed`);
    process.exit(Math.max(...parts.map(({ code }) => code)));
  }
}
