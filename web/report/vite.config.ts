// SPDX-License-Identifier: GPL-3.0-or-later
// One script and one style sheet for each page, which the stylet program carries inside and writes into it:
//   vite build                      the report of an insertion
//   vite build --mode reproduce     the page of stylet reproduce
//   vite build --mode validate      the page of stylet validate
import { defineConfig } from 'vite';

export default defineConfig(({ mode }) => {
  const page = mode === 'reproduce' || mode === 'validate' ? { name: mode, entry: `src/${mode}/main.ts` } : { name: 'report', entry: 'src/main.ts' };
  return {
    build: {
      target: 'es2020',
      cssCodeSplit: false,
      emptyOutDir: false,
      lib: { entry: page.entry, formats: ['iife'], name: 'stylet', fileName: () => `${page.name}.js` },
      rollupOptions: { output: { assetFileNames: `${page.name}[extname]` } },
    },
  };
});
