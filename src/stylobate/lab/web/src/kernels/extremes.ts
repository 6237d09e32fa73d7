/**
 * Extremes of the histories of a run between its samples: a chart that has them shows the motion, not its sampling.
 *
 * The server finds them in the same way, in `lab/extremes.py`, where the numbers below are explained.
 */

export type Histories = Readonly<Record<string, ArrayLike<number | null>>>;

/** Returns histories by name at times that do not fall [s]. */
export type Sample = (times: readonly number[]) => Histories;

type Point = readonly [time: number, value: number];

const PER_PERIOD = 20;
const MOST = 60_000;
const SEEN = 1e-3;
const ROUNDS = 3;
const BESIDE = 2;

/** A turning point: of which history, 1 for a maximum and -1 for a minimum, and what is known about it in its order. */
interface Turning {
  readonly name: string;
  readonly sign: number;
  points: readonly Point[];
}

/** Returns the extremes of each history, those that are seen; `frequency` is the highest of the motion [rad/s]. */
export function extremesOf(sample: Sample, time: readonly number[], frequency: number): Record<string, Point[]> {
  if (time.length < 2 * BESIDE + 1) return {};
  const [from, to] = [time[0]!, time.at(-1)!];
  const wanted = Math.ceil((PER_PERIOD * (time[1]! - from) * frequency) / (2 * Math.PI));
  const parts = Math.max(1, Math.min(wanted, Math.floor(MOST / time.length)));
  const steps = (time.length - 1) * parts;
  const dense = Array.from({ length: steps + 1 }, (_, k) => (k === steps ? to : from + ((to - from) * k) / steps));
  const histories = sample(dense);
  const turning = Object.entries(histories).flatMap(([name, values]) => turningsOf(name, dense, values));
  for (let round = 0; round < ROUNDS && turning.length > 0; round += 1) refine(turning, sample);
  const found: Record<string, Point[]> = {};
  for (const [name, values] of Object.entries(histories)) {
    const own = turning.filter((one) => one.name === name).map((one) => ({ sign: one.sign, point: bestOf(one) }));
    const kept = seen(
      time,
      Array.from(time, (_, k) => values[k * parts] ?? NaN),
      own,
    );
    if (kept.length > 0) found[name] = kept;
  }
  return found;
}

/** Returns the height of a curve as it is drawn: from zero on, and without rare peaks. */
function heightOf(values: ArrayLike<number | null>): number {
  const known = Array.from(values)
    .filter((value): value is number => value !== null && Number.isFinite(value))
    .sort((a, b) => a - b);
  if (known.length === 0) return 0;
  const [low, high] = [quantile(known, 0.01), quantile(known, 0.99)];
  return Math.max(high, 0) - Math.min(low, 0) || Math.max(Math.abs(known[0]!), Math.abs(known.at(-1)!));
}

/** Returns a quantile of ordered values, linear between them. */
function quantile(ordered: readonly number[], share: number): number {
  const place = share * (ordered.length - 1);
  const [below, rest] = [Math.floor(place), place % 1];
  const low = ordered[below] ?? NaN;
  return low + rest * ((ordered[below + 1] ?? low) - low);
}

function turningsOf(name: string, dense: readonly number[], values: ArrayLike<number | null>): readonly Turning[] {
  const height = heightOf(values);
  if (!(height > 0)) return [];
  const found: Turning[] = [];
  for (let k = 1; k < dense.length - 1; k += 1) {
    const [before, after] = [at(values, k) - at(values, k - 1), at(values, k + 1) - at(values, k)];
    if (!(before * after <= 0 && Math.max(Math.abs(before), Math.abs(after)) > SEEN * height)) continue;
    const first = Math.min(Math.max(k, BESIDE), dense.length - 1 - BESIDE) - BESIDE;
    const points = Array.from({ length: 2 * BESIDE + 1 }, (_, i): Point => [dense[first + i]!, at(values, first + i)]);
    found.push({ name, sign: before - after > 0 ? 1 : -1, points });
  }
  return found;
}

function at(values: ArrayLike<number | null>, k: number): number {
  return values[k] ?? NaN;
}

/** Adds what the run is at the times where the extremes may lie. */
function refine(turning: readonly Turning[], sample: Sample): void {
  const asked = turning.flatMap((one) => predicted(one).map((time) => ({ one, time, value: NaN })));
  asked.sort((a, b) => a.time - b.time);
  const shown = sample(asked.map(({ time }) => time));
  asked.forEach((entry, k) => (entry.value = at(shown[entry.one.name] ?? [], k)));
  const added = new Map<Turning, Point[]>();
  for (const { one, time, value } of asked) added.set(one, [...(added.get(one) ?? []), [time, value]]);
  for (const [one, points] of added) one.points = [...one.points, ...points].sort((a, b) => a[0] - b[0]);
}

/** Returns where an extreme may lie: at the vertex of a parabola, or at a kink on either side of the best value. */
function predicted({ points, sign }: Turning): readonly number[] {
  const values = points.map(([, value]) => (Number.isFinite(value) ? sign * value : -Infinity));
  const best = values.indexOf(Math.max(...values));
  const near = Math.min(Math.max(best, BESIDE), points.length - 1 - BESIDE) - BESIDE;
  const [t, v] = [0, 1].map((part) =>
    points.slice(near, near + 5).map((point) => (part === 0 ? point[0] : sign * point[1])),
  );
  const [t0, t1, t2, t3, t4] = t as [number, number, number, number, number];
  const [v0, v1, v2, v3, v4] = v as [number, number, number, number, number];
  const slopes = [(v1 - v0) / (t1 - t0), (v2 - v1) / (t2 - t1), (v3 - v2) / (t3 - t2), (v4 - v3) / (t4 - t3)] as const;
  const bend = (slopes[2] - slopes[1]) / (t3 - t1);
  const vertex = t2 - (slopes[1] + bend * (t2 - t1)) / (2 * bend);
  const left = (v2 - v1 + slopes[0] * t1 - slopes[2] * t2) / (slopes[0] - slopes[2]);
  const right = (v3 - v2 + slopes[1] * t2 - slopes[3] * t3) / (slopes[1] - slopes[3]);
  return [vertex, left, right].map((time) => (Number.isFinite(time) ? Math.min(Math.max(time, t1), t3) : t2));
}

function bestOf({ points, sign }: Turning): Point {
  return points.reduce((best, one) => (sign * one[1] > sign * best[1] || Number.isNaN(best[1]) ? one : best));
}

/** Returns the highest maximum and the lowest minimum between each two samples, if they are seen beside these. */
function seen(
  time: readonly number[],
  samples: readonly number[],
  found: readonly { readonly sign: number; readonly point: Point }[],
): Point[] {
  const height = heightOf(samples);
  const [step, last] = [time[1]! - time[0]!, time.length - 2];
  const kept = new Map<number, Point>();
  for (const { sign, point } of found) {
    let between = Math.min(Math.max(Math.floor((point[0] - time[0]!) / step), 0), last);
    if (time[between]! > point[0]) between -= 1;
    else if (between < last && time[between + 1]! <= point[0]) between += 1;
    const ends = [samples[between]!, samples[between + 1]!].filter(Number.isFinite).map((value) => sign * value);
    const value = sign * point[1];
    if (!Number.isFinite(value) || value <= Math.max(...ends) + 0.5 * SEEN * height) continue;
    const key = 2 * between + (sign > 0 ? 1 : 0);
    const before = kept.get(key);
    if (before === undefined || value > sign * before[1]) kept.set(key, point);
  }
  return [...kept.values()].sort((a, b) => a[0] - b[0]);
}
