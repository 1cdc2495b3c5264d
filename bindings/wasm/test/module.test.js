// node --test: the module by itself, and against the program on the same documents.
// FREIFORM names the program, FREIFORM_WASM the folder of the modules.
import assert from 'node:assert';
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { basename, join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';
import { load } from '../freiform.js';
import { difference, questions, tests } from './cases.js';

const root = new URL('../../../', import.meta.url).pathname;
const program = process.env.FREIFORM ?? join(root, 'build-dev/bin/freiform');
const modules = process.env.FREIFORM_WASM ?? join(root, 'build-wasm/bin');
const ff = await load(pathToFileURL(join(modules, 'freiform.wasm')));

for (const [name, run] of Object.entries(tests)) test(name, () => run(ff));

test('the module is small', () => {
  const size = (name) => gzipSync(readFileSync(join(modules, name)), { level: 9 }).length;
  const all = size('freiform.wasm') + gzipSync(readFileSync(join(root, 'bindings/wasm/freiform.js'))).length;
  const curves = size('freiform-curves.wasm');
  console.log(`gzipped: everything ${all} bytes, curves and surfaces alone ${curves}`);
  assert(all < 1.8e6 && curves < 4.1e5, `${all} and ${curves}`);
});

test('shapes alone have values and nearest points, and no commands', async () => {
  const small = await load(readFileSync(join(modules, 'freiform-curves.wasm')));
  const names = Object.keys(tests).filter((n) => /curve is evaluated|says what it is|dragging|grid|basis|nearest|memory/.test(n));
  assert.equal(names.length, 7);
  for (const name of names) tests[name](small);
  assert.throws(() => small.run('info', { type: 'curve', points: [[0], [1]] }), { kind: 'unavailable' });
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
