/** `topple render` opens the page with ?render=TOKEN: it makes the film that render.json asks for and sends it back. */

import type { Player } from '../player/player.svelte.ts';
import type { Stage } from '../player/stage.svelte.ts';
import { makeFilm, type FilmOrder } from './film.ts';

type RenderOrder = Omit<FilmOrder, 'to'> & { token: string; theme: 'light' | 'dark' };

export function renderToken(): string | null {
  return new URLSearchParams(location.search).get('render');
}

export async function renderToOrder(player: Player, stage: Stage, setTheme: (theme: 'light' | 'dark') => void): Promise<void> {
  const token = renderToken() ?? '';
  const send = (what: string, body: BodyInit): Promise<unknown> => fetch(`${token}/${what}`, { method: 'POST', body });
  try {
    const order = (await (await fetch('render.json')).json()) as RenderOrder;
    setTheme(order.theme);
    if (player.failure) throw new Error(player.failure);
    let told = 0;
    const film = await makeFilm(player, stage, { ...order, to: NaN }, {
      progress: (done, of) => {
        if (done < of && performance.now() - told < 200) return;
        told = performance.now();
        void send('progress', `${done}/${of}`);
      },
      cancelled: () => false,
    });
    await send('film', film);
  } catch (error) {
    await send('problem', (error as Error).message);
  }
}
