import { defineConfig } from "vite";

// File names are fixed and flat, because the server embeds exactly these files. Nothing in the bundle depends on time or paths, so that CI
// can compare it byte by byte with a fresh build.
export default defineConfig({
  base: "/",
  build: {
    outDir: "bundle",
    emptyOutDir: true,
    target: "es2022",
    cssCodeSplit: false,
    modulePreload: false,
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 1000,
    rolldownOptions: {
      output: {
        entryFileNames: "app.js",
        chunkFileNames: "[name].js",
        assetFileNames: "[name][extname]",
      },
    },
  },
});
