import { existsSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { defineConfig } from "vitest/config";

const at = (path: string): string => fileURLToPath(new URL(path, import.meta.url));
const module = at("../bindings/wasm");
// Where `make wasm` leaves it, or where CMake's preset does.
const packed = [`${module}/freiform.packed`, at("../build-wasm/bin/freiform.packed")].find(existsSync) ?? `${module}/freiform.packed`;

export default defineConfig({
    base: "./",
    resolve: { alias: [{ find: /^freiform\/freiform\.packed/, replacement: packed }, { find: /^freiform$/, replacement: `${module}/freiform.js` }] },
    build: { target: "es2022", assetsInlineLimit: 0, chunkSizeWarningLimit: 900 },
    worker: { format: "es" },
    test: { include: ["tests/unit/**/*.test.ts"] },
    server: { fs: { allow: [".."] } },
});
