// SPDX-License-Identifier: GPL-3.0-or-later
// One script and one style sheet, which the stylet program carries inside and writes into every report.
import { defineConfig } from 'vite';

export default defineConfig({
  build: {
    target: 'es2020',
    cssCodeSplit: false,
    lib: { entry: 'src/main.ts', formats: ['iife'], name: 'styletReport', fileName: () => 'report.js' },
    rollupOptions: { output: { assetFileNames: 'report[extname]' } },
  },
});
