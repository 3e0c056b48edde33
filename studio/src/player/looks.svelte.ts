/** What is drawn over the run or in place of its colours, besides the forces. */

import type { Risk } from '../engine/engine.ts';
import { heatOf, type HeatSort } from './heat.ts';
import type { Player } from './player.svelte.ts';
import type { Stage } from './stage.svelte.ts';

export class Looks {
  /** Empty: the bricks' own colours. */
  heat = $state<HeatSort | ''>('');
  ghost = $state(false);
  hits = $state(false);
  trace = $state(false);

  constructor(
    private readonly player: Player,
    private readonly stage: Stage,
  ) {}

  /** @param risk For the sort `risk`. */
  setHeat(sort: HeatSort | '', risk: Risk | null = null): void {
    this.heat = sort;
    if (!this.player.loaded) return;
    this.stage.view?.bricks.paint(sort ? heatOf(this.player.loaded, sort, risk) : null);
    this.stage.view?.changed();
    this.stage.wake();
  }

  toggleGhost(): void {
    this.ghost = !this.ghost;
    this.stage.view?.showGhost(this.ghost);
    this.stage.wake();
  }

  /** Another run is shown: in its own colours, and where it stands. */
  clear(): void {
    [this.heat, this.ghost] = ['', false];
  }
}
