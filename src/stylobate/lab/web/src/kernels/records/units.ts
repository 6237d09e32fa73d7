/** Units of accelerations and times in files of records; neither is guessed. */

import { Refused } from "../../page/server/source";
import { repr } from "./python";

export const STANDARD_GRAVITY = 9.80665;

const FACTORS: Readonly<Record<string, number>> = { g: STANDARD_GRAVITY, "m/s²": 1, "cm/s²": 0.01, "mm/s²": 0.001 };
const KNOWN = '"g", "m/s²" (m/s2), "cm/s²" (cm/s2, gal) or "mm/s²"';
const SPELLINGS: Readonly<Record<string, string>> = {
  g: "g",
  ...Object.fromEntries(["m/s2", "m/s/s", "ms-2"].map((spelling) => [spelling, "m/s²"])),
  ...Object.fromEntries(["cm/s2", "cm/s/s", "cms-2", "gal", "gals"].map((spelling) => [spelling, "cm/s²"])),
  ...Object.fromEntries(["mm/s2", "mm/s/s"].map((spelling) => [spelling, "mm/s²"])),
};

/** Parses a unit to "g", "m/s²", "cm/s²" or "mm/s²", or null. */
export function unitOf(text: string): string | null {
  const plain = text.trim().toLowerCase().replaceAll(" ", "").replaceAll("sec", "s").replaceAll("²", "2");
  return SPELLINGS[plain.replaceAll("⁻", "-").replaceAll("**", "").replaceAll("^", "")] ?? null;
}

export function unknownUnit(text: string): string {
  return `unknown unit ${repr(text)}. Give accelerations in ${KNOWN}, and state that unit`;
}

/** Returns the factor from the unit of a file to m/s², and the unit in words. */
export function scaleOf(name: string, stated: string | null, units: string | null): [factor: number, words: string] {
  const given = units === null ? null : unitOf(units);
  if (units !== null && given === null) throw new Refused(422, [`units must be ${KNOWN}, got ${repr(units)}`]);
  if (stated !== null && given !== null && stated !== given) {
    const wanted = `units must be left out or ${repr(stated)}, which the file states, got ${repr(units)}`;
    throw new Refused(422, [`${name}: ${wanted}`]);
  }
  const unit = stated ?? given;
  if (unit === null) throw new Refused(422, [`${name}: the file names no unit: state units, ${KNOWN}`]);
  return [FACTORS[unit] ?? NaN, `in ${unit}${stated === null ? " as given" : " as the file states"}`];
}

export interface TimeUnit {
  readonly symbol: string;
  /** Its length [s]. */
  readonly seconds: number;
}

export const SECOND: TimeUnit = { symbol: "s", seconds: 1 };
const TIME_UNITS: readonly (readonly [TimeUnit, string])[] = [
  [SECOND, "s sec secs second seconds sek sekunde sekunden seconde secondes secondi seg segundo segundos"],
  [{ symbol: "ms", seconds: 1e-3 }, "ms msec msecs millisecond milliseconds"],
  [{ symbol: "µs", seconds: 1e-6 }, "µs us µsec usec microsecond microseconds"],
  [{ symbol: "min", seconds: 60 }, "min mins minute minutes"],
];

/** Parses a unit of time; null for other units. */
export function timeUnitOf(text: string): TimeUnit | null {
  const plain = text.trim().toLowerCase().replaceAll("μ", "µ").replace(/\.+$/, ""); // Greek mu, micro sign
  return TIME_UNITS.find(([, spellings]) => spellings.split(" ").includes(plain))?.[0] ?? null;
}

/** Converts a time to s, without the last digits of the product: 35 ms are 0.035 s. */
export function inSeconds(time: number, unit: TimeUnit): number {
  return unit.seconds === 1 ? time : Number((time * unit.seconds).toPrecision(14));
}
