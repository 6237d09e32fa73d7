/** Numbers and units as they are read. */

import { frequencyScaling, joined, shownUnit } from "./units";

const MINUS = "\u2212";
const RAISED: Readonly<Record<string, string>> = { "2": "²", "3": "³", "4": "⁴" };

/** Returns `value` with so many significant digits and no idle zeros: what stands in a number field. */
export function plain(value: number, digits = 4): string {
  if (!Number.isFinite(value)) return "";
  return String(Number(value.toPrecision(digits)));
}

/** Returns the number that is written in a field, with a comma or a true minus sign too; NaN where it is none. */
export function readNumber(text: string): number {
  const written = text.trim().replace(",", ".").replace(MINUS, "-");
  return written === "" ? NaN : Number(written);
}

/** Returns the same for reading: a true minus sign, powers of ten written out. */
export function formatted(value: number | null | undefined, digits = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  const [mantissa = "", exponent] = plain(value, digits).split("e");
  const number = mantissa.replace("-", MINUS);
  return exponent === undefined ? number : `${number}·10^${exponent.replace("+", "").replace("-", MINUS)}`;
}

export function withUnit(value: number | null | undefined, unit: string, digits = 3): string {
  return unit === "" || unit === "1" ? formatted(value, digits) : joined(formatted(value, digits), siWritten(unit));
}

/** Returns a frequency of the base motion [rad/s] as it is shown. */
export function frequencyText(value: number, digits = 4): string {
  const { unit, factor } = frequencyScaling();
  return withUnit(value * factor, unit, digits);
}

/** Returns a unit as it is shown: "m s-2" as m/s², or g for a dimensionless column. */
export function unitWritten(unit: string): string {
  return shownUnit(siWritten(unit));
}

/** Returns "m s-2" as m/s²; what is written with a stroke already stays as it is. */
function siWritten(unit: string): string {
  if (unit === "1") return "";
  if (!/[a-z]-?\d|\s/i.test(unit)) return unit;
  const above: string[] = [];
  const below: string[] = [];
  for (const [, symbol = "", power = ""] of unit.matchAll(/([^\s\d-]+)(-?\d*)/g)) {
    const size = power.replace("-", "");
    const raised = symbol + (size === "1" ? "" : (RAISED[size] ?? size));
    (power.startsWith("-") ? below : above).push(raised);
  }
  return [above.join(" ") || "1", ...below].join("/");
}

/** Returns the label of an axis, such as "angular frequency [rad/s]". */
export function axisLabel(name: string, unit: string): string {
  const shown = unitWritten(unit);
  return shown === "" ? words(name) : `${words(name)} [${shown}]`;
}

/** Returns the name of a quantity as words. */
export function words(name: string): string {
  return name.replaceAll("_", " ");
}

export function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}

/** Returns a time of a run with as many decimals as its length asks for, so that its width does not jump. */
export function clockTime(time: number, length: number): string {
  return time.toFixed(length >= 1000 ? 0 : length >= 20 ? 1 : length >= 2 ? 2 : 3);
}

/** Returns "1 landing", "3 landings". */
export function counted(number: number, one: string, many = `${one}s`): string {
  return `${number} ${number === 1 ? one : many}`;
}

/** Returns a line of the server as a sentence: with a capital and a full stop. */
export function sentence(line: string): string {
  const text = capital(line.trim());
  return text === "" || /[.!?]$/.test(text) ? text : `${text}.`;
}
