/** How many bricks of each colour somebody has: theirs, not a layout's, so that it is kept in the browser. Colours that are not there are without limit. */

const kKey = 'topple.stock';

export type Stock = Record<string, number>;

/** What is not a stock is none. */
export function readStock(): Stock {
  try {
    const kept: unknown = JSON.parse(localStorage.getItem(kKey) ?? '{}');
    if (typeof kept !== 'object' || kept === null) return {};
    return Object.fromEntries(Object.entries(kept).filter(([color, number]) => /^#[0-9a-f]{6}$/.test(color) && Number.isInteger(number) && number >= 0));
  } catch {
    return {};
  }
}

export function writeStock(stock: Stock): void {
  try {
    localStorage.setItem(kKey, JSON.stringify(stock));
  } catch {
    // A browser that keeps nothing: it holds until the page is closed.
  }
}
