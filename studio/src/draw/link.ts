/** A layout as the part of an address after '#', compressed, with the hash that its run gave the sender. */

const kMark = 'layout=';

export interface SharedLayout {
  text: string;
  /** 16 hexadecimal digits, or empty: the sender had not run it. */
  hash: string;
}

async function through(bytes: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  const piped = new Blob([bytes]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(piped).arrayBuffer());
}

export async function makeFragment({ text, hash }: SharedLayout): Promise<string> {
  const packed = await through(new TextEncoder().encode(text), new CompressionStream('deflate'));
  let binary = '';
  for (let at = 0; at < packed.length; at += 8192) binary += String.fromCharCode(...packed.subarray(at, at + 8192));
  const code = btoa(binary).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
  return `#${kMark}${code}${hash ? `&hash=${hash}` : ''}`;
}

/** @returns null: there is no layout in it. @throws Error with a sentence where there is one that cannot be read. */
export async function readFragment(fragment: string): Promise<SharedLayout | null> {
  const found = new RegExp(`^#${kMark}([^&]*)(?:&hash=([0-9a-f]{16}))?$`).exec(fragment);
  if (!found) {
    if (fragment.includes(kMark)) throw new Error('This link is damaged: it holds letters that no link of Topple has.');
    return null;
  }
  try {
    const binary = atob(found[1].replace(/-/g, '+').replace(/_/g, '/'));
    const bytes = await through(Uint8Array.from(binary, (c) => c.charCodeAt(0)), new DecompressionStream('deflate'));
    return { text: new TextDecoder('utf-8', { fatal: true }).decode(bytes), hash: found[2] ?? '' };
  } catch {
    throw new Error('This link is damaged or was cut off: the layout in it cannot be unpacked.');
  }
}

/** "7f3a 91c2": enough of a hash for people. */
export const hashWords = (hash: string): string => `${hash.slice(0, 4)} ${hash.slice(4, 8)}`;
