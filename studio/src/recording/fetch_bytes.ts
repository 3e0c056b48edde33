/** Why a recording could not be fetched, as a sentence. */
export class FetchError extends Error {
  override name = 'FetchError';
  constructor(
    message: string,
    /** True when there is nothing at the address: then the page asks for a file instead. */
    readonly absent = false,
  ) {
    super(message);
  }
}

/** All bytes at an address. `progress` hears how many have come, and of how many (0: not known). */
export async function fetchBytes(url: string, progress: (done: number, of: number) => void): Promise<Uint8Array> {
  let answer: Response;
  try {
    answer = await fetch(url);
  } catch {
    throw new FetchError('The recording cannot be fetched: the server does not answer. Is `topple show` still running?');
  }
  if (answer.status === 404 || answer.status === 204) throw new FetchError('There is no recording here.', true);
  if (!answer.ok || !answer.body) throw new FetchError(`The recording cannot be fetched: the server answers ${answer.status}.`);
  const of = Number(answer.headers.get('content-length') ?? 0);
  const parts: Uint8Array[] = [];
  let done = 0;
  const reader = answer.body.getReader();
  for (;;) {
    const { value } = await reader.read();
    if (!value) break;
    parts.push(value);
    done += value.length;
    progress(done, of);
  }
  if (done === 0) throw new FetchError('There is no recording here.', true); // plain files hold an empty one in its place
  const all = new Uint8Array(done);
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}
