// Pictures a second of Inspect beside those of three.js alone, with the same triangles in the same browser; writes bench/STUDIO.md.
// Needs studio/dist (npm run build) and the program.      node tests/browser/speed.mjs [rounds]
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { loadavg, cpus, tmpdir } from "node:os";
import { dirname, extname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { serve } from "./served.mjs";

const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "../../.."), studio = join(here, "../..");
const rounds = Number(process.argv[2] ?? 3), kPictures = 12, load = loadavg()[0];
const program = process.env.FREIFORM ?? ["build", "build-dev", "build-demo"].map((folder) => join(root, folder, "bin/freiform")).find(existsSync);
const scratch = mkdtempSync(join(tmpdir(), "freiform-speed-"));
const sleep = (ms) => new Promise((done) => setTimeout(done, ms));
async function until(page, f, seconds = 120) {
    const last = Date.now() + 1000 * seconds;
    while (!(await page.evaluate(f).catch(() => false))) {
        if (Date.now() > last) throw new Error(`never: ${f}`);
        await sleep(50);
    }
}

// Three.js as its manual starts with it: one mesh from a file, one lamp and a sky, a picture for each turn.
const kPlain = `<!doctype html><style>body{margin:0}canvas{display:block}</style>
<script type="importmap">{"imports": {"three": "/three/build/three.module.js"}}</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "/three/examples/jsm/loaders/GLTFLoader.js";
const [width, height] = location.hash.slice(1).split(",").map(Number);
const renderer = new THREE.WebGLRenderer({ antialias: true });
renderer.setSize(width, height);
document.body.append(renderer.domElement);
const scene = new THREE.Scene(), eye = new THREE.PerspectiveCamera(32, width / height, 0.01, 1000);
const { scene: model } = await new GLTFLoader().loadAsync("/model.glb");
const look = new THREE.MeshStandardMaterial({ color: "#88a", side: THREE.DoubleSide, roughness: 0.55, metalness: 0.05 });
let triangles = 0;
model.traverse((o) => { if (o.isMesh) { o.material = look; triangles += o.geometry.index.count / 3; } });
const lamp = new THREE.DirectionalLight(0xffffff, 1.9);
lamp.position.set(0.6, 1.2, 1.5);
eye.add(lamp);
scene.add(model, new THREE.HemisphereLight(0xffffff, 0x8a8f99, 1.6), eye);
const box = new THREE.Box3().setFromObject(model), middle = box.getCenter(new THREE.Vector3()), radius = box.getSize(new THREE.Vector3()).length() / 2;
const away = new THREE.Vector3(4, 4, 6).normalize().multiplyScalar(0.9 * radius / Math.sin(16 * Math.PI / 180) / Math.min(1, width / height));
eye.near = away.length() / 200, eye.far = 20 * away.length();
eye.updateProjectionMatrix();
window.turn = () => requestAnimationFrame(() => {
    away.applyAxisAngle(new THREE.Vector3(0, 1, 0), 0.12);
    eye.position.copy(middle).add(away);
    eye.lookAt(middle);
    renderer.render(scene, eye);
});
window.turn();
window.triangles = triangles;
</script>`;

function plain(glb) {
    const types = { ".js": "text/javascript" };
    const server = createServer((request, response) => {
        const path = new URL(request.url, "http://x").pathname;
        const answer = path === "/" ? Promise.resolve(kPlain) : path === "/model.glb" ? Promise.resolve(glb)
            : path.startsWith("/three/") ? readFile(join(studio, "node_modules", path)) : Promise.reject(new Error(path));
        answer.then((bytes) => { response.writeHead(200, { "Content-Type": path === "/" ? "text/html" : types[extname(path)] ?? "application/octet-stream" }); response.end(bytes); },
            () => { response.writeHead(404); response.end(); });
    });
    return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve({ url: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() })));
}

/** Milliseconds for a picture: `key` (or window.turn) asks for each, reading a pixel waits until it is drawn. */
const timed = (page, key, level) => page.evaluate(async ([key, level, pictures]) => {
    const canvas = document.querySelector("canvas"), gl = canvas.getContext("webgl2"), pixel = new Uint8Array(4);
    const picture = async () => {
        if (key) canvas.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true, cancelable: true }));
        else window.turn();
        await new Promise((done) => requestAnimationFrame(done));
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    };
    for (let i = 0; i < 3; ++i) await picture();
    const began = performance.now();
    for (let i = 0; i < pictures; ++i) await picture();
    const each = (performance.now() - began) / pictures;
    const shown = document.querySelector(".view.space")?.dataset.level ?? "fine";
    if (shown !== level) throw new Error(`${shown} instead of ${level}`);
    return each;
}, [key, level, kPictures]);

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"] });
const site = await serve(join(studio, "dist"));
const page = await (await browser.newContext({ viewport: { width: 1100, height: 700 }, locale: "en-GB" })).newPage();
const rows = [];
for (const [steps, least] of [[17, 150000], [22, 800000]]) {
    await page.goto("about:blank");
    await page.goto(`${site.url}#/inspect`);
    await page.waitForSelector(".view.space", { timeout: 20000 });
    await until(page, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 100);
    await page.getByLabel("Tolerance", { exact: true }).focus();
    for (let i = 0; i < steps; ++i) await page.keyboard.press("ArrowRight");
    const began = Date.now();
    while (Number(await page.evaluate(() => document.querySelector(".view.space").dataset.triangles)) < least) {
        if (Date.now() - began > 300000) throw new Error(`never ${least} triangles`);
        await sleep(200);
    }
    await until(page, () => {  // the coarse level is there
        document.querySelector("canvas").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
        return document.querySelector(".view.space").dataset.level === "coarse";
    }, 300);
    await until(page, () => document.querySelector(".view.space").dataset.level === "fine");
    const triangles = Number(await page.evaluate(() => document.querySelector(".view.space").dataset.triangles));
    const size = await page.evaluate(() => { const { clientWidth, clientHeight } = document.querySelector("canvas"); return [clientWidth, clientHeight]; });
    const tolerance = await page.evaluate(() => (document.querySelector("input[aria-label=Tolerance]").closest("label")?.innerText.match(/[0-9][0-9.e-]*/) ?? [""])[0]);
    const file = join(scratch, `${steps}.glb`);
    execFileSync(program, ["tessellate", join(root, "examples/teapot.bpt"), "--tolerance", tolerance, "-o", file], { stdio: "ignore" });
    const other = await plain(readFileSync(file));
    const bare = await (await browser.newContext({ viewport: { width: 1100, height: 700 } })).newPage();
    await bare.goto(`${other.url}#${size}`);
    await until(bare, () => window.triangles > 0);
    const times = { plain: [], all: [], moving: [] };
    for (let k = 0; k < rounds; ++k) {
        await bare.bringToFront();
        times.plain.push(await timed(bare, "", "fine"));
        await page.bringToFront();
        await sleep(600);
        times.all.push(await timed(page, "5", "fine"));
        times.moving.push(await timed(page, "ArrowLeft", "coarse"));
        await sleep(600);
    }
    rows.push({ triangles, bare: await bare.evaluate(() => window.triangles), size, ...times });
    await bare.context().close();
    other.close();
}
await browser.close();
site.close();
rmSync(scratch, { recursive: true, force: true });

const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const table = rows.map(({ triangles, bare, plain, all, moving }) => `| ${triangles} (${bare}) | ${median(plain).toFixed(0)} ms | ${median(all).toFixed(0)} ms | ` +
    `${(median(plain) / median(all)).toFixed(2)} | ${median(moving).toFixed(0)} ms | ${(median(plain) / median(moving)).toFixed(1)} |`).join("\n");
writeFileSync(join(root, "bench/STUDIO.md"), `# The studio's pictures beside those of three.js alone

Made by \`node studio/tests/browser/speed.mjs\`; do not edit. The teapot in Chromium with software rendering (SwiftShader), ${rows[0].size.join(" x ")} pixels, antialiased.
Milliseconds for a picture until it is drawn, medians of ${rounds} rounds in turns, ${kPictures} pictures each; 16.7 ms is the least that a browser takes. Three.js alone: the
same model, meshed by the program within the same tolerance to three digits (its triangles in brackets), one mesh with a standard material, a lamp and a sky.
All triangles: what is drawn while nothing moves. Turning: the coarser level that stands for it while the eye moves.
Load when it began: ${load.toFixed(1)} on ${cpus().length} processors.

| triangles | three.js | all triangles | three.js / studio | turning | three.js / studio |
|---:|---:|---:|---:|---:|---:|
${table}
`);
console.log(table);
