// node tests/browser/speed.mjs: milliseconds for a picture of a million triangles in Inspect, all of them and while the eye
// moves, beside three.js alone with as many triangles on a canvas of the same size. Rounds alternate; medians. Needs studio/dist.
import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { serve } from "./served.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const rounds = Number(process.argv[2] ?? 5), pictures = Number(process.argv[3] ?? 8);
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", ...(process.env.CHROMIUM_ARGS ?? "").split(" ").filter(Boolean)] });
// The sphere of three.js has 2 (n - 1) m triangles.
const alone = `import * as THREE from "./three.module.js";
globalThis.begin = (width, height, triangles) => {
    const n = Math.ceil(Math.sqrt(triangles / 4));
    const renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    renderer.setSize(width, height, false);
    document.body.append(renderer.domElement);
    const scene = new THREE.Scene(), eye = new THREE.PerspectiveCamera(32, width / height, 0.1, 100), lamp = new THREE.DirectionalLight(0xffffff, 1.9);
    const ball = new THREE.Mesh(new THREE.SphereGeometry(1, 2 * n, n), new THREE.MeshStandardMaterial({ roughness: 0.55, metalness: 0.05, side: THREE.DoubleSide }));
    eye.position.set(0, 0, 4);
    eye.add(lamp);
    scene.add(eye, ball, new THREE.HemisphereLight(0xffffff, 0x8a8f99, 1.6));
    globalThis.turn = () => { ball.rotation.y += 0.12; renderer.render(scene, eye); };
    return ball.geometry.index.count / 3;
};`;
const three = join(here, "../../node_modules/three/build/three.module.js");
const site = await serve(join(here, "../../dist"), { "/alone.js": alone, "/three.module.js": readFileSync(three),
    "/alone.html": '<!doctype html><meta charset="utf-8"><title>three.js</title><body><script type="module" src="./alone.js"></script>' });

const viewport = { width: 1100, height: 700 };
const studio = await (await browser.newContext({ viewport })).newPage(), plain = await (await browser.newContext({ viewport })).newPage();
const wait = async (page, f) => { while (!(await page.evaluate(f).catch(() => false))) await new Promise((done) => setTimeout(done, 100)); };

// Two spheres, so finely that they are a million triangles.
const ball = (x) => ({ type: "surface", degrees: [2, 2], knots: [[0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], [0, 0, 0, 1, 1, 2, 2, 2]],
    ...(() => {
        const r = Math.SQRT1_2, round = [[1, 0, 1], [1, 1, r], [0, 1, 1], [-1, 1, r], [-1, 0, 1], [-1, -1, r], [0, -1, 1], [1, -1, r], [1, 0, 1]];
        const over = [[0, -1, 1], [1, -1, r], [1, 0, 1], [1, 1, r], [0, 1, 1]];
        return { points: round.map(([a, b]) => over.map(([c, d]) => [x + a * c, b * c, d])), weights: round.map(([, , v]) => over.map(([, , w]) => v * w)) };
    })() });
await studio.goto(`${site.url}#/inspect`);
await wait(studio, () => Number(document.querySelector(".view.space")?.dataset.triangles) > 0);
const document_ = JSON.stringify({ freiform: 1, objects: [ball(-1.1), ball(1.1)] });
const data = await studio.evaluateHandle((text) => { const t = new DataTransfer(); t.items.add(new File([text], "balls.json")); return t; }, document_);
await studio.locator(".stage").dispatchEvent("drop", { dataTransfer: data });
await studio.waitForSelector("text=balls.json");
await studio.getByLabel("Tolerance", { exact: true }).press("End");
await wait(studio, () => Number(document.querySelector(".view.space").dataset.triangles) > 3e5);
const triangles = await studio.evaluate(() => Number(document.querySelector(".view.space").dataset.triangles));
await wait(studio, () => {
    document.querySelector("canvas").dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
    return document.querySelector(".view.space").dataset.level === "coarse";
});
const [width, height] = await studio.evaluate(() => { const c = document.querySelector("canvas"); return [c.width, c.height]; });
await plain.goto(`${site.url}alone.html`);
await wait(plain, () => typeof globalThis.begin === "function");
const count = await plain.evaluate(([w, h, n]) => globalThis.begin(w, h, n), [width, height, triangles]);

// Each picture has ended when one of its pixels is here.
const inStudio = (moving) => studio.evaluate(async ([n, moving]) => {
    const view = document.querySelector(".view.space"), canvas = view.querySelector("canvas"), gl = canvas.getContext("webgl2"), pixel = new Uint8Array(4);
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    const times = [];
    for (let i = 0; i < n; ++i) {
        const before = performance.now();
        canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft" }));
        if (!moving) while (view.dataset.level !== "fine") await new Promise((done) => setTimeout(done, 5));
        const began = moving ? before : performance.now();
        await frame();
        await frame();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        times.push(performance.now() - began);
    }
    return times;
}, [pictures, moving]);
const inPlain = () => plain.evaluate(async (n) => {
    const canvas = document.querySelector("canvas"), gl = canvas.getContext("webgl2"), pixel = new Uint8Array(4);
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    const times = [];
    for (let i = 0; i < n; ++i) {
        const began = performance.now();
        await frame();
        globalThis.turn();
        await frame();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        times.push(performance.now() - began);
    }
    return times;
}, pictures);
const median = (list) => [...list].sort((a, b) => a - b)[list.length >> 1];
const all = { fine: [], moving: [], plain: [] };
for (let r = 0; r < rounds; ++r) {
    await plain.bringToFront();
    all.plain.push(median(await inPlain()));
    await studio.bringToFront();
    all.fine.push(median(await inStudio(false)));
    all.moving.push(median(await inStudio(true)));
}
await browser.close();
site.close();
const [fine, moving, alone_] = [median(all.fine), median(all.moving), median(all.plain)];
console.log(JSON.stringify({ triangles, triangles_alone: count, canvas: [width, height], three_ms: alone_, studio_ms: fine, studio_moving_ms: moving,
    rate_to_three: alone_ / fine, rate_to_three_moving: alone_ / moving }, null, 1));
