// SPDX-License-Identifier: GPL-3.0-or-later
// One script and one style sheet for each page, which the stylet program carries inside:
//   vite build --mode live          the page of stylet serve
//   vite build --mode report        the report of an insertion
//   vite build --mode dose          the report of stylet dose
//   vite build --mode implant       the report of stylet implant
//   vite build --mode reproduce     the page of stylet reproduce
//   vite build --mode validate      the page of stylet validate
import { defineConfig } from 'vite';

const ENTRIES: Record<string, string> = {
  live: 'live/src/main.ts',
  report: 'report/src/main.ts',
  dose: 'report/src/dose/main.ts',
  implant: 'report/src/implant/main.ts',
  reproduce: 'report/src/reproduce/main.ts',
  validate: 'report/src/validate/main.ts',
};

export default defineConfig(({ mode }) => {
  const entry = ENTRIES[mode];
  if (!entry) throw new Error(`There is no page "${mode}": --mode takes ${Object.keys(ENTRIES).join(', ')}`);
  return {
    build: {
      target: 'es2020',
      cssCodeSplit: false,
      emptyOutDir: false,
      lib: { entry, formats: ['iife'], name: 'stylet', fileName: () => `${mode}.js` },
      rollupOptions: { output: { assetFileNames: `${mode}[extname]` } },
    },
  };
});
