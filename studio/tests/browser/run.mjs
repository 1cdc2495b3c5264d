// The studio as readers meet it: in Chromium, by mouse, keyboard and finger. Needs studio/dist (npm run build).
//     node tests/browser/run.mjs [part of a name ..]        STUDIO_PICTURES=folder keeps screenshots
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { serve, viewed } from "./served.mjs";
import { cases } from "./cases.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const pictures = process.env.STUDIO_PICTURES;
if (pictures) mkdirSync(pictures, { recursive: true });
const scratch = join(tmpdir(), `freiform-studio-${process.pid}`);
mkdirSync(scratch, { recursive: true });

const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", ...(process.env.CHROMIUM_ARGS ?? "").split(" ").filter(Boolean)] });
const dist = join(here, "../../dist");
const site = await serve(dist);
const root = join(here, "../../..");
const program = process.env.FREIFORM ?? ["build-dev", "build", "build-demo"].map((folder) => join(root, folder, "bin/freiform")).find(existsSync);
const wanted = process.argv.slice(2);
let failed = 0, passed = 0;

/** A page of its own, watched: nothing may be thrown, nothing may leave the machine. */
async function opened(options, url) {
    const context = await browser.newContext({ viewport: { width: 1100, height: 700 }, locale: "en-GB", acceptDownloads: true, ...options });
    const page = await context.newPage();
    const trouble = [];
    page.on("filechooser", () => undefined);  // choosers are caught from the start: asked for with the key that opens one, the catching came too late in 3 of 40 runs
    page.on("pageerror", (error) => trouble.push(`thrown: ${error.message}`));
    page.on("console", (message) => { if (message.type() === "error" && !/404 \(Not Found\)/.test(message.text())) trouble.push(`console: ${message.text()}`); });
    page.on("request", (request) => { if (!/^(data|blob):/.test(request.url()) && !request.url().startsWith(url)) trouble.push(`request: ${request.url()}`); });
    return { context, page, trouble };
}

// Pages of Explore follow each other without loading anew, as a reader turns them.
let common;

for (const [name, act, options = {}] of cases) {
    if (wanted.length > 0 && !wanted.some((w) => name.includes(w))) continue;
    if (options.view && !program) { console.log(`SKIP  ${name}: the program is not built`); continue; }
    const began = performance.now();
    const own = options.extra ? await serve(dist, options.extra()) : options.view ? await viewed(program, dist, options.view(scratch)) : site;
    const { context, page, trouble } = options.common ? (common ??= await opened({}, own.url)) : await opened(options.context ?? {}, own.url);
    let fine = false;
    try {
        await act({ page, context, url: own.url, scratch, trouble, view: (file) => viewed(program, dist, file), write: (file, text) => { const path = join(scratch, file); writeFileSync(path, text); return path; },
            read: (path) => readFileSync(path), picture: async (file) => { if (pictures) await page.screenshot({ path: join(pictures, `${file}.png`) }); } });
        if (trouble.length > 0) throw new Error(trouble.join("\n    "));
        fine = true;
        ++passed;
        console.log(`ok    ${name} (${Math.round(performance.now() - began)} ms)`);
    } catch (error) {
        ++failed;
        console.log(`FAIL  ${name}\n    ${error.message.split("\n").slice(0, 12).join("\n    ")}`);
        if (pictures) await page.screenshot({ path: join(pictures, `failed-${name.replace(/\W+/g, "-")}.png`) }).catch(() => undefined);
    }
    if (!options.common || !fine) {
        await context.close();
        if (options.common) common = undefined;
    }
    if (own !== site) own.close();
}
await browser.close();
site.close();
rmSync(scratch, { recursive: true, force: true });
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed > 0 || passed === 0 ? 1 : 0);
