// node webgl.mjs gpu-webgl FILE..: the page that examples/gpu/webgl.cpp writes, drawn by WebGL 2 in Chromium, against the
// library's picture by OpenGL ES. Exit code 1 if they differ; 77 where there is no Chromium or no OpenGL.
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [program, ...files] = process.argv.slice(2);
const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium', kWidth = 320, kHeight = 240;
const folder = mkdtempSync(join(tmpdir(), 'freiform-webgl-'));
const skip = (why) => { console.log(why); rmSync(folder, { recursive: true, force: true }); process.exit(77); };
if (!existsSync(chromium)) skip(`${chromium} is not there`);

const script = `<script>
const tell = (head, body) => fetch('/answer', { method: 'POST', headers: { 'x-says': encodeURIComponent(head) }, body });
try {
  draw({ ...surfaces.view, zoom: 1 }, ${kWidth}, ${kHeight}, [1, 0, 1]);
  const rgba = new Uint8Array(${4 * kWidth * kHeight});
  gl.readPixels(0, 0, ${kWidth}, ${kHeight}, gl.RGBA, gl.UNSIGNED_BYTE, rgba);
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  tell((info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : 'WebGL') + ', error ' + gl.getError(), rgba);
} catch (error) { tell(String(error.stack), ''); }
</script>`;

async function drawnInChromium(page) {
  let answered;
  const answer = new Promise((resolve) => { answered = resolve; });
  const server = createServer((request, reply) => {
    if (request.url === '/') {
      // Errors of the page itself end the wait too.
      const early = `<script>onerror = (m) => fetch('/answer', { method: 'POST', headers: { 'x-says': encodeURIComponent(m) } });</script>`;
      return reply.writeHead(200, { 'Content-Type': 'text/html' }).end(page.replace('<canvas>', early + '<canvas>') + script);
    }
    if (request.url !== '/answer') return reply.writeHead(404).end();
    const parts = [];
    request.on('data', (part) => parts.push(part));
    request.on('end', () => {
      reply.writeHead(204).end();
      answered({ says: decodeURIComponent(request.headers['x-says']), rgba: Buffer.concat(parts) });
    });
  });
  await new Promise((ready) => server.listen(0, '127.0.0.1', ready));
  const browser = spawn(chromium, ['--headless=new', '--no-sandbox', '--disable-dev-shm-usage', '--no-first-run',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader', `--user-data-dir=${join(folder, 'profile')}`,
    `http://127.0.0.1:${server.address().port}/`], { stdio: 'ignore' });
  const late = setTimeout(() => answered({ says: 'no answer within 200 s', rgba: Buffer.alloc(0) }), 200000);
  const found = await answer;
  clearTimeout(late);
  browser.kill();
  await new Promise((ended) => browser.once('exit', ended));
  server.close();
  return found;
}

// Of the picture of the page, whose rows begin at the bottom, and of the library's.
const ofPage = (rgba) => (x, y) => rgba.subarray(4 * ((kHeight - 1 - y) * kWidth + x));
const ofLibrary = (rgb) => (x, y) => rgb.subarray(3 * (y * kWidth + x));
const background = (p) => (p[0] + p[2]) / 2 - p[1];

// As tests/gpu/compared_pictures.hpp has it.
function compared(a, b) {
  const found = { cracked: 0, different: 0, surface: 0 };
  const neighbours = (x, y) => [-1, 0, 1].flatMap((i) => [-1, 0, 1].map((j) => [x + i, y + j]));
  const isBeyond = (one, other, x, y) => [0, 1, 2].some((c) => {
    const around = neighbours(x, y).map((at) => other(...at)[c]);
    return one(x, y)[c] < Math.min(...around) - 12 || one(x, y)[c] > Math.max(...around) + 12;
  });
  for (let y = 1; y + 1 < kHeight; ++y)
    for (let x = 1; x + 1 < kWidth; ++x) {
      if (Math.max(...neighbours(x, y).map((at) => background(b(...at)))) >= 3) continue;
      ++found.surface;
      found.cracked += background(a(x, y)) > 6;
      found.different += isBeyond(a, b, x, y) || isBeyond(b, a, x, y);
    }
  return found;
}

let wrong = 0;
for (const file of files) {
  const page = join(folder, 'page.html'), picture = join(folder, 'picture.ppm');
  const made = spawnSync(program, [file, page, picture], { encoding: 'utf8' });
  if (made.status !== 0 && /OpenGL/.test(made.stderr)) skip(made.stderr);
  if (made.status !== 0) throw new Error(`${program} ${file}: ${made.stderr}`);
  const html = readFileSync(page, 'utf8'), ppm = readFileSync(picture);
  const { says, rgba } = await drawnInChromium(html);
  if (process.env.FREIFORM_PICTURES && rgba.length) {
    const rgb = Buffer.alloc(3 * kWidth * kHeight), pixel = ofPage(rgba);
    for (let y = 0; y < kHeight; ++y) for (let x = 0; x < kWidth; ++x) pixel(x, y).copy(rgb, 3 * (y * kWidth + x), 0, 3);
    writeFileSync(join(process.env.FREIFORM_PICTURES, 'webgl.ppm'), Buffer.concat([ppm.subarray(0, 15), rgb]));
    writeFileSync(join(process.env.FREIFORM_PICTURES, 'es.ppm'), ppm);
  }
  const found = rgba.length === 4 * kWidth * kHeight ? compared(ofPage(rgba), ofLibrary(ppm.subarray(15))) : null;
  const good = found && found.cracked === 0 && found.different <= found.surface / 1000 && found.surface > 5000;
  console.log(`${file}: ${says}: ${found ? JSON.stringify(found) : 'no picture'}`);
  wrong += !good;
}
try {
    rmSync(folder, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
} catch (e) {
    console.error(`left behind: ${e.message}`);  // Chromium's own processes end after it, and write there
}
process.exit(wrong ? 1 : 0);
