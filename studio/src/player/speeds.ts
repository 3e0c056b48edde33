/** How fast the recording is played: a logarithmic slider with stops. */

export const kSlowest = 1 / 50;
export const kFastest = 8;
export const kStops = [1 / 50, 1 / 10, 1 / 4, 1, 2, 8];

const kSpan = Math.log(kFastest / kSlowest);
/** A slider this close to a stop goes to it, as a part of its length. */
const kCatch = 0.025;

/** Place on the slider, 0 to 1. */
export function placeOf(speed: number): number {
  return Math.log(speed / kSlowest) / kSpan;
}

export function speedAtPlace(place: number): number {
  const stop = kStops.find((s) => Math.abs(placeOf(s) - place) < kCatch);
  return stop ?? kSlowest * Math.exp(kSpan * Math.min(1, Math.max(0, place)));
}

/** The next stop that is faster (way 1) or slower (way -1). */
export function nextStop(speed: number, way: 1 | -1): number {
  const stops = way > 0 ? kStops : [...kStops].reverse();
  return stops.find((stop) => way * (stop - speed) > 1e-6 * speed) ?? speed;
}

/** "1/10×", "2×", "0.37×". */
export function speedWords(speed: number): string {
  const inverse = Math.round(1 / speed);
  if (speed < 1 && Math.abs(inverse * speed - 1) < 1e-3) return `1/${inverse}×`;
  return `${speed < 1 ? speed.toFixed(2) : speed < 10 && speed % 1 ? speed.toFixed(1) : speed.toFixed(0)}×`;
}

/** The fastest stop at most 1 at which a run of this length [s] plays for three seconds or more. */
export function firstSpeed(duration: number): number {
  const fits = kStops.filter((stop) => stop <= 1 && duration / stop >= 3);
  return fits.length > 0 ? fits[fits.length - 1] : kSlowest;
}
