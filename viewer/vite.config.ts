// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vite'

// One file of each kind under a fixed name: the program embeds them.
export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    modulePreload: false,
    chunkSizeWarningLimit: 2000,
    rollupOptions: {
      output: { entryFileNames: 'viewer.js', assetFileNames: 'viewer.[ext]', inlineDynamicImports: true },
    },
  },
})
