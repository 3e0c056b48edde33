/** The forces at contacts, step by step, as the engine hands them over (topple_watch_steps): read where they lie. */

const kHead = 16;
const kContact = 32;
export const kFloor = 0xffffffff;

/** One point where something presses on a brick. */
export interface ContactForce {
  brick: number;
  /** What presses on it; kFloor: the floor. */
  by: number;
  /** From the brick's foot as it was put down [m]. */
  point: [number, number, number];
  /** On the brick, friction included [N]. */
  force: [number, number, number];
}

/** Consecutive steps of a run. */
export class ContactSteps {
  /** Of each step [s], and where it begins in the bytes. */
  readonly times: Float64Array;
  private readonly places: Uint32Array;
  private readonly view: DataView;

  constructor(readonly bytes: Uint8Array<ArrayBuffer>) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const times: number[] = [];
    const places: number[] = [];
    for (let at = 0; at + kHead <= bytes.length; at += kHead + kContact * this.view.getUint32(at + 8, true)) {
      times.push(this.view.getFloat64(at, true));
      places.push(at);
    }
    this.times = Float64Array.from(times);
    this.places = Uint32Array.from(places);
  }

  get first(): number {
    return this.times[0] ?? Infinity;
  }
  get last(): number {
    return this.times.at(-1) ?? -Infinity;
  }

  /** Everything that presses at a step. */
  at(step: number): ContactForce[] {
    const place = this.places[step];
    if (place === undefined) return [];
    const count = this.view.getUint32(place + 8, true);
    return Array.from({ length: count }, (_, i) => {
      const at = place + kHead + i * kContact;
      const triple = (from: number): [number, number, number] => [0, 4, 8].map((k) => this.view.getFloat32(from + k, true)) as [number, number, number];
      return { brick: this.view.getUint32(at, true), by: this.view.getUint32(at + 4, true), point: triple(at + 8), force: triple(at + 20) };
    });
  }
}
