import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";

const at = (path: string): string => fileURLToPath(new URL(path, import.meta.url));
const module = at("../bindings/wasm");
// Where `make wasm` leaves it, or where CMake's preset does.
const wasm = [`${module}/freiform.wasm`, at("../build-wasm/bin/freiform.wasm")].find(existsSync) ?? `${module}/freiform.wasm`;

export default defineConfig({
    base: "./",
    resolve: { alias: [{ find: /^freiform\/freiform\.wasm/, replacement: wasm }, { find: /^freiform$/, replacement: `${module}/freiform.js` }] },
    build: { target: "es2022", assetsInlineLimit: 0, chunkSizeWarningLimit: 900 },
    worker: { format: "es" },
    test: { include: ["tests/unit/**/*.test.ts"] },
    server: { fs: { allow: [".."] } },
});
