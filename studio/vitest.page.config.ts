import { defineConfig } from 'vitest/config';

// The browser draws in software: slow, and one at a time.
export default defineConfig({
  test: { include: ['tests/page/*.test.ts'], environment: 'node', testTimeout: 60000, hookTimeout: 60000, fileParallelism: false, expect: { poll: { timeout: 20000, interval: 50 } } },
});
