import { defineConfig } from 'vitest/config';
import { kPatience } from './tests/patience.ts';

export default defineConfig({ test: { include: ['tests/unit/*.test.ts', 'tests/engine/*.test.ts'], testTimeout: 5 * kPatience, environment: 'node' } });
