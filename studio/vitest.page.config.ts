import { defineConfig } from 'vitest/config';
import { kPatience } from './tests/patience.ts';

// The browser draws in software: slow, and one at a time.
export default defineConfig({
  test: { include: ['tests/page/*.test.ts'], environment: 'node', testTimeout: 5 * kPatience, hookTimeout: 2 * kPatience, fileParallelism: false, expect: { poll: { timeout: kPatience, interval: 50 } } },
});
