// The built page on 127.0.0.1, with the headers that `freiform view` sends; files given in `extra` are served as well.
import { spawn } from "node:child_process";
import { createServer } from "node:http";
import { readFile } from "node:fs/promises";
import { extname, join, normalize } from "node:path";

const kTypes = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".svg": "image/svg+xml", ".json": "application/json",
    ".webmanifest": "application/manifest+json" };
const kPolicy = "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self'; " +
    "connect-src 'self' blob: data:; worker-src 'self' blob:; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

export function serve(folder, extra = {}) {
    const server = createServer((request, response) => {
        const path = normalize(decodeURIComponent(new URL(request.url, "http://x").pathname)).replace(/^(\.\.[/\\])+/, "");
        const name = path === "/" ? "/index.html" : path;
        const answer = name in extra ? Promise.resolve(extra[name]) : readFile(join(folder, name));
        answer.then((bytes) => {
            response.writeHead(200, { "Content-Type": kTypes[extname(name)] ?? "application/octet-stream", "Content-Security-Policy": kPolicy, "Cache-Control": "no-cache" });
            response.end(bytes);
        }, () => { response.writeHead(404, { "Content-Type": "text/plain" }); response.end("not found"); });
    });
    return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve({ url: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() })));
}

/** What `freiform view` serves, at the address that it prints. */
export function viewed(program, page, file) {
    const child = spawn(program, ["view", file, "--no-browser", "--page", page], { stdio: ["ignore", "pipe", "pipe"] });
    return new Promise((resolve, reject) => {
        let said = "", complained = "";
        child.stderr.on("data", (part) => { complained += part; });
        child.stdout.on("data", (part) => {
            said += part;
            if (said.includes("\n")) resolve({ url: said.slice(0, said.indexOf("\n")), close: () => child.kill() });
        });
        child.on("error", reject);
        child.on("exit", (code) => { reject(Object.assign(new Error(`freiform view ended with ${code}: ${complained}`), { code, complained })); });
    });
}
