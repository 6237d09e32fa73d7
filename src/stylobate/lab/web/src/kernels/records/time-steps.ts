/** Equal time steps of a column of times, also of times that were printed with few digits. */

import { general } from "../general";
import type { RecordText } from "./text";
import { SECOND, type TimeUnit, inSeconds } from "./units";

/** Tolerance of times that are printed with few digits, as a fraction of a step. */
const TIME_SLACK = 0.02;
// A single different step is a missing sample, and so are rare double steps; see `even_grid` in Python.
const LEAST_EXCEPTIONS = 3;
const RARE = 0.05;
/** Tolerance for rounding of the differences, relative to the last printed digit. */
const SLACK = 1e-6;
const LONGEST_DECIMAL = 12;
const HALVINGS = 60;

/** First time and step. */
type Steps = readonly [start: number, step: number];

/** Returns first time and step [s] of equally spaced `times`; `step` [s] is the given one, `places` their lines. */
export function equalSteps(
  text: RecordText,
  times: Float64Array,
  places: readonly number[],
  step: number | null,
  unit: TimeUnit = SECOND,
): Steps {
  requireTwo(text, places);
  const own = meanStep(times);
  const steps = differences(times);
  const typical = median(steps);
  const wrong = steps.some((one) => Math.abs(one - typical) > TIME_SLACK * Math.abs(typical));
  if (own <= 0 || typical <= 0 || wrong) {
    const rounded = evenGrid(times, step === null ? null : step / unit.seconds);
    if (!rounded) throw unequal(text, times, places, step, unit);
    return [inSeconds(rounded[0], unit), step ?? inSeconds(rounded[1], unit)];
  }
  if (step !== null && Math.abs(own * unit.seconds - step) > TIME_SLACK * step) {
    const problem = `the times are in steps of ${general(own, 6)} ${unit.symbol}, not of the step given, `;
    throw text.fault(places[1] ?? 0, `${problem}${general(step, 6)} s. Correct step, or leave it out`);
  }
  return [inSeconds(times[0] ?? NaN, unit), step ?? inSeconds(asPrinted(own), unit)];
}

export function requireTwo(text: RecordText, places: readonly number[]): void {
  if (places.length >= 2) return;
  throw text.fault(places[0] ?? text.lines.length - 1, "the file is too short: one sample. Give two or more");
}

function unequal(
  text: RecordText,
  times: Float64Array,
  places: readonly number[],
  step: number | null,
  { symbol }: TimeUnit,
): Error {
  const steps = differences(times);
  const common = median(steps);
  const isWrong = (one: number): boolean => (common > 0 ? Math.abs(one - common) > TIME_SLACK * common : one <= 0);
  const first = Math.max(0, steps.findIndex(isWrong));
  const [before, after, between] = [times[first], times[first + 1], steps[first]].map((value) => value ?? NaN);
  const most = common > 0 ? `, most are ${general(common, 3)} ${symbol}` : "";
  const problem = `unequal time steps: ${general(before ?? NaN, 6)} ${symbol} to ${general(after ?? NaN, 6)} ${symbol}`;
  const remedy = `Resample the file${step === null ? ", or state step, in s, if its times are rounded" : ""}`;
  return text.fault(places[first + 1] ?? 0, `${problem} is ${general(between ?? NaN, 3)} ${symbol}${most}. ${remedy}`);
}

function meanStep(times: Float64Array): number {
  return ((times.at(-1) ?? NaN) - (times[0] ?? NaN)) / (times.length - 1);
}

function differences(times: Float64Array): Float64Array {
  return times.slice(1).map((time, k) => time - (times[k] ?? NaN));
}

function median(values: Float64Array): number {
  const sorted = values.slice().sort();
  const middle = sorted.length >> 1;
  const upper = sorted[middle] ?? NaN;
  return sorted.length % 2 === 1 ? upper : ((sorted[middle - 1] ?? NaN) + upper) / 2;
}

/** A quotient of sums is 0.02 except for rounding; the intended step has few digits. */
function asPrinted(step: number): number {
  const short = Number(step.toPrecision(9));
  return Math.abs(short - step) <= 1e-9 * step ? short : step;
}

// Rounded times

/** Returns the even grid whose rounded values are `times`, of this step if it is given; null if there is none. */
function evenGrid(times: Float64Array, step: number | null): Steps | null {
  const half = lastDigits(times).map((digit) => digit / 2);
  if (step === null && samplesAreMissing(times, Math.min(...extremes(half)))) return null;
  const slack = SLACK * Math.max(...extremes(half));
  for (const candidate of step === null ? simplest(middleStep(times, half)) : [step]) {
    const { first, last } = gap(candidate, times, half);
    if (first > last + slack) continue;
    const start = times[0] ?? NaN;
    return [first - slack <= start && start <= last + slack ? start : (first + last) / 2, candidate];
  }
  return null;
}

function extremes(values: Float64Array): [number, number] {
  return [values.reduce((one, other) => Math.min(one, other)), values.reduce((one, other) => Math.max(one, other))];
}

/** Returns whether unequal steps are gaps, and not rounding. */
function samplesAreMissing(times: Float64Array, half: number): boolean {
  const counts = new Map<number, number>();
  for (const one of differences(times)) {
    const step = Math.round(one / half);
    counts.set(step, (counts.get(step) ?? 0) + 1);
  }
  const sorted = [...counts].sort(([one], [other]) => one - other);
  const [common, frequent] = sorted.reduce((most, one) => (one[1] > most[1] ? one : most));
  const exceptions = times.length - 1 - frequent;
  const gaps = sorted.reduce((sum, [step, count]) => sum + (step >= 2 * common ? count : 0), 0);
  const missing = common > 0 && exceptions === gaps && gaps < RARE * (times.length - 1);
  return meanStep(times) <= 0 || exceptions < LEAST_EXCEPTIONS || missing;
}

/** Returns the first times of even grids that agree with all times, and the sign of the error of the step. */
function gap(step: number, times: Float64Array, half: Float64Array): { first: number; last: number; side: number } {
  let [first, last, low, high] = [-Infinity, Infinity, 0, 0];
  times.forEach((time, k) => {
    const [rest, slack] = [time - step * k, half[k] ?? NaN];
    if (rest - slack > first) [first, low] = [rest - slack, k];
    if (rest + slack < last) [last, high] = [rest + slack, k];
  });
  return { first, last, side: low - high };
}

/** Returns the step of the even grid closest to all times, by bisection. */
function middleStep(times: Float64Array, half: Float64Array): number {
  const mean = meanStep(times);
  const reach = (2 * Math.max(...extremes(half))) / (times.length - 1);
  let [low, high] = [Math.max(0, mean - reach), mean + reach];
  for (let k = 0; k < HALVINGS; k += 1) {
    const step = 0.5 * (low + high);
    [low, high] = gap(step, times, half).side > 0 ? [step, high] : [low, step];
  }
  return 0.5 * (low + high);
}

/** Returns the unit of the last digit of each time; later times reveal trailing zeros. */
function lastDigits(times: Float64Array): Float64Array {
  let finest = 0;
  return times
    .map((time) => {
      const [mantissa = "", power = "0"] = time.toExponential().split("e");
      return Math.min(0, Number(power) - mantissa.replace(/^-?\d\.?/, "").length);
    })
    .reverse()
    .map((exponent) => Number(`1e${(finest = Math.min(finest, exponent))}`))
    .reverse();
}

/** Yields steps close to `step`, the simplest first: decimals, and a rate such as 128 Hz before 0.00781 s. */
function* simplest(step: number): Generator<number> {
  for (let digits = 1; digits < LONGEST_DECIMAL; digits += 1) {
    const short = Number(step.toPrecision(digits));
    if (short !== 0) yield short;
    if (digits === 2 && step > 0 && step < 1) yield 1 / Math.round(1 / step);
  }
  yield step;
}
