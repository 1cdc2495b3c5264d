// node browser.js [--speed]: the tests of cases.js, and all questions to the examples, in a page of Chromium. The page's
// answers have to be those of node, bit for bit; the C++ tests (corpus.js) are run, too, where they were built.
// FREIFORM_GTEST_FILTER chooses some. Exit code 1 if something is wrong; 77 where there is no Chromium.
import { spawn } from 'node:child_process';
import { mkdtempSync, readFileSync, readdirSync, rmSync, existsSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { load } from '../freiform.js';
import { questions } from './cases.js';

const root = new URL('../../../', import.meta.url).pathname;
const modules = process.env.FREIFORM_WASM ?? join(root, 'build-wasm/bin');
const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium';
if (!existsSync(chromium)) {
  console.log(`${chromium} is not there`);
  process.exit(77);
}

const folder = join(root, 'examples/gallery');
const documents = Object.fromEntries(readdirSync(folder).filter((f) => f.endsWith('.json')).slice(0, 8)
  .map((f) => [f, readFileSync(join(folder, f), 'utf8')]));
const page = `<!doctype html><meta charset="utf-8"><script type="module">
import { load } from '/freiform.js';
import { tests } from '/test/cases.js';
import { run } from '/test/corpus.js';
import { speed } from '/test/speed.js';
const tell = (body) => fetch('/answer', { method: 'POST', body: JSON.stringify(body) });
try {
  const { documents, questions, wantsSpeed, filter } = await (await fetch('/task')).json();
  const ff = await load('/freiform.packed'), failed = [], answers = {};
  for (const [name, run] of Object.entries(tests))
    try { run(ff); } catch (error) { failed.push(name + ': ' + error.stack); }
  for (const [name, content] of Object.entries(documents))
    for (const [command, ...options] of questions) {
      const args = [command, name, ...options], { code, stdout } = ff.command(args, { [name]: content });
      answers[args.join(' ')] = [code, new TextDecoder().decode(stdout)];
    }
  const corpus = await fetch('/freiform-tests.wasm');
  const tested = corpus.ok && !wantsSpeed ? await run(await WebAssembly.compile(await corpus.arrayBuffer()), ['--gtest_brief=1', '--gtest_filter=' + filter]) : null;
  if (tested && tested.code !== 0) failed.push(tested.said);
  await tell({ corpus: tested?.passed, count: Object.keys(tests).length, failed, answers, speed: wantsSpeed ? speed(ff) : null });
} catch (error) { await tell({ count: 0, failed: [String(error.stack)], answers: {} }); }
</script>`;

const wantsSpeed = process.argv.includes('--speed');
let answered;
const answer = new Promise((resolve) => { answered = resolve; });
const server = createServer((request, reply) => {
  const send = (type, body) => reply.writeHead(200, { 'Content-Type': type }).end(body);
  const script = 'text/javascript';
  if (request.url === '/') return send('text/html', page);
  if (/^\/(freiform|unpack)\.js$/.test(request.url)) return send(script, readFileSync(join(root, 'bindings/wasm', request.url)));
  if (/^\/test\/\w+\.js$/.test(request.url)) return send(script, readFileSync(join(root, 'bindings/wasm', request.url)));
  if (request.url === '/freiform.packed') return send('application/octet-stream', readFileSync(join(modules, 'freiform.packed')));
  const corpus = join(modules, 'freiform-tests.wasm');
  if (request.url === '/freiform-tests.wasm' && existsSync(corpus)) return send('application/wasm', readFileSync(corpus));
  if (request.url === '/task') return send('application/json', JSON.stringify({ documents, questions, wantsSpeed, filter: process.env.FREIFORM_GTEST_FILTER ?? '*' }));
  if (request.url !== '/answer') return reply.writeHead(404).end();
  let body = '';
  request.on('data', (part) => { body += part; });
  request.on('end', () => { reply.writeHead(204).end(); answered(JSON.parse(body)); });
});
await new Promise((ready) => server.listen(0, '127.0.0.1', ready));

const profile = mkdtempSync(join(tmpdir(), 'freiform-chromium-'));
const browser = spawn(chromium, ['--headless=new', '--no-sandbox', '--disable-gpu', '--disable-dev-shm-usage', '--no-first-run',
  `--user-data-dir=${profile}`, `http://127.0.0.1:${server.address().port}/`], { stdio: 'ignore' });
const late = setTimeout(() => answered({ count: 0, failed: ['no answer within 600 s'], answers: {} }), 600000);
const found = await answer;
clearTimeout(late);
browser.kill();
await new Promise((ended) => browser.once('exit', ended));
server.close();
try {
  rmSync(profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
} catch (e) {
  console.error(`left behind: ${e.message}`);  // Chromium's own processes end after it, and write there
}

const ff = await load(readFileSync(join(modules, 'freiform.wasm')));
const withoutTimes = (s) => s.replace(/"seconds": \{[^}]*\}/g, '');
let same = 0;
for (const [name, content] of Object.entries(documents))
  for (const [command, ...options] of questions) {
    const args = [command, name, ...options], { code, stdout } = ff.command(args, { [name]: content });
    const theirs = found.answers[args.join(' ')];
    if (theirs?.[0] === code && withoutTimes(theirs[1]) === withoutTimes(new TextDecoder().decode(stdout))) ++same;
    else found.failed.push(`${args.join(' ')}: other than in node`);
  }
if (wantsSpeed) console.log(JSON.stringify(found.speed));
else console.log(`in Chromium: ${found.count} tests, ${same} answers equal to node's, ${found.failed.length} wrong${found.corpus ? `; ${found.corpus} C++ tests` : ''}`);
for (const line of found.failed) console.error(line);
process.exit(found.failed.length > 0 || found.count === 0 ? 1 : 0);
