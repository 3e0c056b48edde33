import { svelte } from '@sveltejs/vite-plugin-svelte';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';
import { publishedSources } from './published.ts';

// Relative addresses, so that the built page works from any folder of any server.
export default defineConfig({
  base: './',
  plugins: [svelte(), publishedSources(fileURLToPath(new URL('../validation', import.meta.url)))],
  worker: { format: 'es' },
  build: { target: 'es2022', chunkSizeWarningLimit: 1500, assetsInlineLimit: 0 },
});
