import { defineConfig } from "vite";

// The same page as one module for notebooks: a notebook loads it from memory, so it can import nothing beside it.
export default defineConfig({
  build: {
    outDir: "../src/halfway/notebook/bundle",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 4000,
    lib: { entry: "src/widget.ts", formats: ["es"], fileName: () => "widget.js", cssFileName: "widget" },
    rolldownOptions: { output: { codeSplitting: false } },
  },
});
