/**
 * The units in which numbers are shown: SI, or those of a column with m = g = ω₀ = 1, whose numbers are the same.
 *
 * In a lesson frequencies are shown in Hz and tilts in degrees.
 */

/** What SI units are of a dimensionless column. */
const OWN: Readonly<Record<string, string>> = {
  s: "1/ω₀",
  "rad/s": "ω₀",
  Hz: "ω₀",
  m: "g/ω₀²",
  "m/s": "g/ω₀",
  "m/s²": "g",
};

let dimensionless = false;
let taught = false;

/** Shows numbers from now on in the units of a column of this shape, in a lesson or outside. */
export function setUnitsOf(shape: unknown, lesson = false): void {
  dimensionless = shape === "dimensionless";
  taught = lesson;
}

/** Whether a lesson is shown, whose reader knows no symbols. */
export function isTaught(): boolean {
  return taught;
}

/** A unit, and how many of it are one of the unit in which a quantity is kept. */
export interface Scaling {
  readonly unit: string;
  readonly factor: number;
}

/** Returns the unit in which a frequency of the base motion is shown; it is kept in rad/s. */
export function frequencyScaling(): Scaling {
  return taught && !dimensionless ? { unit: "Hz", factor: 0.5 / Math.PI } : { unit: "rad/s", factor: 1 };
}

/** Returns the unit in which a tilt is shown, of a column of this slenderness; it is kept in rad. */
export function tiltScaling(slenderness: number): Scaling {
  return taught ? { unit: "°", factor: 180 / Math.PI } : { unit: " c", factor: 1 / slenderness };
}

export function isDimensionless(): boolean {
  return dimensionless;
}

/** Returns the name under which an SI unit is shown. */
export function shownUnit(unit: string): string {
  return (dimensionless && OWN[unit]) || unit;
}

/** Returns a text of the server in which each number has its unit, with the units that are shown. */
export function inShownUnits(text: string): string {
  if (!dimensionless) return text;
  return text.replaceAll(/([\d.e]+) (rad\/s|m\/s²|m\/s|Hz|m|s)(?![\w/²])/g, (_, number: string, unit: string) =>
    joined(number, unit),
  );
}

/** Returns a number that is written already with its unit: "60 s", or "60/ω₀". */
export function joined(number: string, unit: string): string {
  const shown = shownUnit(unit);
  return shown.startsWith("1/") ? number + shown.slice(1) : `${number} ${shown}`;
}
