// node webgl.mjs gpu-webgl FILE..: the page that examples/gpu/webgl.cpp writes, drawn by WebGL 2 in Chromium, against the
// library's picture by OpenGL ES, and against one of a fine mesh of eight times the size: surfaces, cracks, and how far edges lie
// from their places. Exit code 1 if they differ; 77 where there is no Chromium or no OpenGL.
import { spawn, spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, extname, join } from 'node:path';

const [program, ...files] = process.argv.slice(2);
const chromium = process.env.CHROMIUM ?? '/usr/bin/chromium', kWidth = 320, kHeight = 240, kFiner = 8;
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

const background = (p) => (p[0] + p[2]) / 2 - p[1], kFull = 255;
const neighbours = (x, y) => [-1, 0, 1].flatMap((i) => [-1, 0, 1].map((j) => [x + i, y + j]));
const inner = function* () {
  for (let y = 1; y + 1 < kHeight; ++y) for (let x = 1; x + 1 < kWidth; ++x) yield [x, y];
};

// The picture of the page, whose rows begin at the bottom.
const ofPage = (rgba) => (x, y) => rgba.subarray(4 * ((kHeight - 1 - y) * kWidth + x));

// That of the mesh: means of its pixels, the least and the most of them.
function ofMesh(rgb) {
  const sums = new Float64Array(3 * kWidth * kHeight), low = new Uint8Array(sums.length).fill(255), high = new Uint8Array(sums.length);
  for (let i = 0; i < rgb.length / 3; ++i) {
    const x = i % (kFiner * kWidth), y = (i - x) / (kFiner * kWidth), at = 3 * (Math.floor(y / kFiner) * kWidth + Math.floor(x / kFiner));
    for (let c = 0; c < 3; ++c) {
      const value = rgb[3 * i + c];
      sums[at + c] += value / kFiner ** 2, low[at + c] = Math.min(low[at + c], value), high[at + c] = Math.max(high[at + c], value);
    }
  }
  const of = (all) => (x, y) => all.subarray(3 * (y * kWidth + x));
  return { mean: of(sums), low: of(low), high: of(high) };
}

// As tests/gpu/compared_pictures.hpp has it: what one of four samples shows may be less than a quarter of the pixel, so that the
// page may show all that the mesh has around.
function compared(page, mesh) {
  const found = { cracked: 0, different: 0, surface: 0 }, kBy = 12;
  const isBeyond = (pixel, low, high, x, y) => [0, 1, 2].some((c) => {
    const all = neighbours(x, y);
    return pixel[c] < Math.min(...all.map((at) => low(...at)[c])) - kBy || pixel[c] > Math.max(...all.map((at) => high(...at)[c])) + kBy;
  });
  for (const [x, y] of inner()) {
    if (Math.max(...neighbours(x, y).map((at) => background(mesh.mean(...at)))) >= 3) continue;
    ++found.surface;
    found.cracked += background(page(x, y)) > 6;
    found.different += isBeyond(page(x, y), mesh.low, mesh.high, x, y) || isBeyond(mesh.mean(x, y), page, page, x, y);
  }
  return found;
}

// How many of the smaller pixels are surface in rectangles: of what is drawn, or of all within half a pixel of it.
function coverage(rgb) {
  const w = kFiner * kWidth, h = kFiner * kHeight, half = kFiner / 2;
  const isIn = new Uint8Array(w * h).map((_, i) => background(rgb.subarray(3 * i, 3 * i + 3)) < kFull / 2);
  const along = (from, step, count, other, jump, by) => {
    const out = new Uint8Array(w * h);
    for (let j = 0; j < other; ++j)
      for (let i = 0, here = 0; i < count + half; ++i) {
        const at = (k) => from[j * jump + Math.min(Math.max(k, 0), count - 1) * step];
        if (i === 0) for (let k = -half; k < half; ++k) here += at(k);
        else here -= at(i - half - 1);
        here += at(i + half);
        if (i < count) out[j * jump + i * step] = here >= by;
      }
    return out;
  };
  const spread = (by) => along(along(isIn, 1, w, h, w, by), w, h, w, 1, by);
  const share = (of) => (x, y) => {
    let sum = 0;
    for (let j = 0; j < kFiner; ++j) for (let i = 0; i < kFiner; ++i) sum += of[(kFiner * y + j) * w + kFiner * x + i];
    return sum / kFiner ** 2;
  };
  return { exact: share(isIn), grown: share(spread(1)), shrunk: share(spread(2 * half + 1)) };
}

// As tests/gpu/trimmed_edges_test.cpp has it: pixels that show more or less than edges within half a pixel could.
function edgeErrors(a, shares) {
  const found = { beyond: 0, boundary: 0, area: 0 }, kSample = 0.26;
  for (const [x, y] of inner()) {
    const share = 1 - background(a(x, y)) / kFull, exact = shares.exact(x, y), grown = shares.grown(x, y), shrunk = shares.shrunk(x, y);
    const more = grown === 0 ? 0.02 : kSample, less = shrunk === 1 ? 0.1 : kSample;
    found.beyond += share > grown + more || share < shrunk - less;
    found.boundary += exact > 0 && exact < 1;
    if (grown !== shrunk) found.area += share - exact;
  }
  return found;
}

let wrong = 0;
for (const file of files) {
  const page = join(folder, 'page.html'), picture = join(folder, 'picture.ppm'), es = join(folder, 'es.ppm');
  const made = spawnSync(program, [file, page, picture, es], { encoding: 'utf8' });
  if (made.status !== 0 && /OpenGL/.test(made.stderr)) skip(made.stderr);
  if (made.status !== 0) throw new Error(`${program} ${file}: ${made.stderr}`);
  const html = readFileSync(page, 'utf8'), ppm = readFileSync(picture);
  const { says, rgba } = await drawnInChromium(html);
  const small = readFileSync(es), library = small.subarray(small.length - 3 * kWidth * kHeight);
  const rgb = ppm.subarray(ppm.length - 3 * kFiner ** 2 * kWidth * kHeight);
  let found = null;
  if (rgba.length === 4 * kWidth * kHeight) {
    const page = ofPage(rgba), mesh = ofMesh(rgb);
    const same = (x, y) => library.subarray(3 * (y * kWidth + x));
    found = { ...compared(page, mesh), ...edgeErrors(page, coverage(rgb)), library: compared(page, { mean: same, low: same, high: same }) };
    const keep = (name, colour) => {
      const bytes = [];
      for (let y = 0; y < kHeight; ++y) for (let x = 0; x < kWidth; ++x) for (let c = 0; c < 3; ++c) bytes.push(colour(x, y, c));
      writeFileSync(join(process.env.FREIFORM_PICTURES, name), Buffer.concat([Buffer.from(`P6\n${kWidth} ${kHeight}\n255\n`), Buffer.from(bytes)]));
    };
    if (process.env.FREIFORM_PICTURES) {
      const name = basename(file, extname(file));
      keep(`${name}_webgl.ppm`, (x, y, c) => page(x, y)[c]);
      keep(`${name}_mesh.ppm`, (x, y, c) => Math.round(mesh.mean(x, y)[c]));
      keep(`${name}_difference.ppm`, (x, y, c) => Math.abs(page(x, y)[c] - Math.round(mesh.mean(x, y)[c])));
    }
  }
  const isOne = ({ cracked, different, surface }) => cracked === 0 && different <= surface / 1000 && surface > 5000;
  // Seams show half of their reach beyond an edge.
  const good = found && isOne(found) && isOne(found.library) &&
    found.beyond === 0 && found.boundary > 150 && Math.abs(found.area) < 0.4 * found.boundary;
  console.log(`${file}: ${says}: ${found ? JSON.stringify(found) : 'no picture'}`);
  wrong += !good;
}
try {
    rmSync(folder, { recursive: true, force: true, maxRetries: 10, retryDelay: 200 });
} catch (e) {
    console.error(`left behind: ${e.message}`);  // Chromium's own processes end after it, and write there
}
process.exit(wrong ? 1 : 0);
