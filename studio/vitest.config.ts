import { defineConfig } from 'vitest/config';

export default defineConfig({ test: { include: ['tests/unit/*.test.ts', 'tests/engine/*.test.ts'], testTimeout: 30000, environment: 'node' } });
