/** The units in which numbers are shown: SI, or those of a column with m = g = ω₀ = 1, whose numbers are the same. */

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

/** Shows numbers from now on in the units of a column of this shape. */
export function setUnitsOf(shape: unknown): void {
  dimensionless = shape === "dimensionless";
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
