import { defineConfig } from "vitest/config";
import { fileURLToPath } from "node:url";

const module = fileURLToPath(new URL("../bindings/wasm", import.meta.url));

export default defineConfig({
    base: "./",
    resolve: { alias: { freiform: module } },
    build: { target: "es2022", assetsInlineLimit: 0, chunkSizeWarningLimit: 900 },
    worker: { format: "es" },
    test: { include: ["tests/unit/**/*.test.ts"] },
    server: { fs: { allow: [".", module] } },
});
