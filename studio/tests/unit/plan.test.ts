/** The plan that stands in for the view where there is no WebGL. */

import { expect, test } from 'vitest';
import { hull } from '../../src/panels/plan.ts';

test('the outline of a brick that lies on its side is a rectangle, although two of its corners fall on each of the plan’s', () => {
  // 48 mm across, 7.5 mm along, seen from above: top and bottom corners in one place each.
  const corners = [-24, 24].flatMap((y) => [-3.75, 3.75].flatMap((x): [number, number][] => [[x, y], [x, y]]));
  const outline = hull(corners);
  expect(outline.length).toBe(4);
  const area = outline.reduce((sum, [x, y], i) => {
    const [nx, ny] = outline[(i + 1) % 4];
    return sum + 0.5 * (x * ny - nx * y);
  }, 0);
  expect(area).toBeCloseTo(48 * 7.5, 9);
});

test('a tipping brick covers its foot and its top, and what lies inside is no corner', () => {
  expect(hull([[0, 0], [4, 0], [4, 2], [0, 2], [2, 1], [2, 0]]).sort()).toEqual([[0, 0], [0, 2], [4, 0], [4, 2]]);
});
