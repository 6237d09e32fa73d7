/** A case that is carried to a column of another size: the same motion in units of gravity and of the column's own time. */

import type { Description, Part, Value } from "./description";
import { isVector } from "./description";
import { angularFrequency, withAngularFrequency } from "./frequency";

const GRAVITY = 9.80665; // m/s²

/** m h²/J0 of a slender body. */
const INERTIA = 0.75;

interface Scale {
  readonly slenderness: number;
  readonly gravity: number;
  readonly frequency: number;
}

/**
 * Returns a case with a column of another shape at that column's scale, where a dimensionless column was exchanged for
 * one with lengths or the other way round; a change among columns with lengths leaves the base as it moves.
 */
export function atScaleOf(found: Description, before: Description): Description {
  if (isBare(found.column) === isBare(before.column)) return found;
  const [to, from] = [scaleOf(found.column), scaleOf(before.column)];
  const [tilt, frequency] = [to.slenderness / from.slenderness, to.frequency / from.frequency];
  return {
    ...found,
    motion: moved(found.motion, to.gravity / from.gravity, frequency),
    ...times(found, "tilt", tilt),
    ...times(found, "tilt_rate", tilt * frequency),
    ...times(found, "spin", frequency),
    ...times(found, "duration", 1 / frequency),
  };
}

function isBare(column: Part): boolean {
  return column["shape"] === "dimensionless";
}

/** Returns the numbers of a column by which its motions scale; of those with lengths, about. */
function scaleOf(column: Part): Scale {
  const number = (name: string, usual: number): number => {
    const value = column[name];
    return typeof value === "number" ? value : usual;
  };
  if (isBare(column)) return { slenderness: number("slenderness", 0.1), gravity: 1, frequency: 1 };
  const height = number("mass_height", number("height", 1) / 2);
  const gravity = number("gravity", GRAVITY);
  return { slenderness: number("radius", 0.1) / height, gravity, frequency: Math.sqrt((INERTIA * gravity) / height) };
}

/** Only what is given by its acceleration scales: a stroke or a record is one of the machine or the site. */
function moved(motion: Part, acceleration: number, frequency: number): Part {
  if (typeof motion["acceleration"] !== "number") return motion;
  const own = angularFrequency(motion) ?? motion["angular_frequency"];
  const faster = typeof own === "number" ? { angular_frequency: rounded(own * frequency) } : {};
  const found = { ...motion, acceleration: rounded(motion["acceleration"] * acceleration), ...faster };
  return typeof own === "number" ? withAngularFrequency(found, own * frequency) : found;
}

function times(description: Description, name: string, factor: number): Part {
  const value: Value | undefined = description[name];
  if (typeof value === "number") return { [name]: rounded(value * factor) };
  if (!isVector(value)) return {};
  return { [name]: value.map((one) => (typeof one === "number" ? rounded(one * factor) : one)) };
}

function rounded(value: number): number {
  return Number(value.toPrecision(3));
}
