import { defineConfig } from "vitest/config";

// The page goes into the Python package, which serves it; `npm run dev` asks a running `halfway view` for data.
export default defineConfig({
  base: "./",
  build: {
    outDir: "../src/halfway/server/page",
    emptyOutDir: true,
    target: "es2022",
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1000,
  },
  server: {
    proxy: { "/api": { target: "http://127.0.0.1:8765", changeOrigin: true } },
  },
  // Other work may share the machine.
  test: { testTimeout: 60_000 },
});
