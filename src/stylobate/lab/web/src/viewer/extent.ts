/** How much room a motion takes: the slab it happens on, the ground below, what the camera must show. */

import { axisOf } from "./attitude";
import type { DrawnMotion, Triple } from "./drawn-motion";
import { isFalling } from "./fall";
import { roundLength } from "./lengths";

export interface Box {
  readonly low: Triple;
  readonly high: Triple;
}

export interface Extent {
  /** The length that thicknesses and widths of lines are given in: of the column as one sees it [m]. */
  readonly size: number;
  /** Grid spacing of slab and ground [m]. */
  readonly spacing: number;
  /** Top of the slab in the frame of the base: x from, y from, x to, y to [m]. */
  readonly slab: readonly [number, number, number, number];
  readonly thickness: number;
  /** Room of the column, seen from where the camera follows to, in the frame of the base. */
  readonly room: Box;
  /** Largest displacement of the base along each axis, seen from where the camera follows to [m]. */
  readonly shake: Triple;
  readonly followsColumn: boolean;
  readonly followsBase: boolean;
}

const FAR = 3; // sizes that a column or its base go before the camera goes with them
const LINES = 60; // of the grid at most, either way
const LOOKS = 400; // instants at which the room is taken

export function extentOf(motion: DrawnMotion): Extent {
  const { radius, top_radius, height } = motion.column;
  const widest = Math.max(radius, top_radius);
  const size = Math.max(2 * widest, 0.6 * height);
  const path = spread(
    [...motion.footprint, ...motion.contact_point, ...fallenTop(motion)].map(([x, y]) => [x, y, 0] as const),
  );
  const shake = spread(motion.base);
  const followsColumn = Math.max(...span(path)) > FAR * size;
  const followsBase = Math.max(...span(shake)) > FAR * size;

  const margin = Math.max(1.1 * widest, 0.16 * height);
  const spacing = roundLength(Math.max(0.14 * size, Math.max(...span(path)) / LINES));
  const out = (edge: number): number => Math.sign(edge) * Math.ceil(Math.abs(edge) / spacing - 1e-9) * spacing;
  // Whole cells of the grid, so that small changes of a motion leave the slab as it is.
  const slab = [
    out(path.low[0] - margin),
    out(path.low[1] - margin),
    out(path.high[0] + margin),
    out(path.high[1] + margin),
  ] as const;
  return {
    size,
    spacing,
    slab,
    thickness: 0.07 * size,
    room: roomOf(motion, followsColumn),
    shake: followsBase
      ? [0, 0, 0]
      : (shake.high.map((high, i) => Math.max(high, -shake.low[i]!, 0)) as unknown as Triple),
    followsColumn,
    followsBase,
  };
}

const APART = 0.3; // sizes between the rooms of two columns

/** Return the room of two columns side by side, and the place of the second on the base along x [m]. */
export function extentBeside(first: Extent, second: Extent): { readonly extent: Extent; readonly place: number } {
  const size = Math.max(first.size, second.size);
  const spacing = Math.max(first.spacing, second.spacing);
  const place = Math.ceil((first.room.high[0] - second.room.low[0] + APART * size) / spacing) * spacing;
  const moved = ([x, y, z]: Triple): Triple => [x + place, y, z];
  const [a, b] = [first.slab, second.slab];
  // The slabs reach as far as the columns may fall: whichever edge is farther out counts.
  const slab = [
    Math.min(a[0], b[0] + place),
    Math.min(a[1], b[1]),
    Math.max(a[2], b[2] + place),
    Math.max(a[3], b[3]),
  ] as const;
  const extent = {
    ...{ size, spacing, slab, thickness: 0.07 * size },
    room: spread([first.room.low, first.room.high, moved(second.room.low), moved(second.room.high)]),
    shake: first.shake.map((one, k) => Math.max(one, second.shake[k]!)) as unknown as Triple,
    followsColumn: first.followsColumn || second.followsColumn,
    followsBase: first.followsBase || second.followsBase,
  };
  return { extent, place };
}

/** Return where the top of a column that falls comes to lie on the base. */
function fallenTop(motion: DrawnMotion): readonly Triple[] {
  if (!isFalling(motion)) return [];
  const axis = axisOf(motion.rotation.at(-1)!);
  return [motion.centre.at(-1)!.map((value, k) => value + motion.column.height * axis[k]!) as unknown as Triple];
}

/** Return the box round the column at all its instants. */
function roomOf(motion: DrawnMotion, follows: boolean): Box {
  const { radius, top_radius, height } = motion.column;
  const step = Math.max(1, Math.floor(motion.time.length / LOOKS));
  const points: Triple[] = [];
  for (let i = 0; i < motion.time.length; i += step) {
    const axis = axisOf(motion.rotation[i]!);
    const centre = motion.centre[i]!;
    const from = follows ? [...motion.footprint[i]!, 0] : [0, 0, 0];
    for (const [along, reach] of [
      [0, radius],
      [height, top_radius],
    ] as const) {
      const middle = centre.map((value, k) => value + along * axis[k]! - from[k]!);
      // A circle reaches along an axis by its radius times the sine of the angle to its normal.
      const reaches = axis.map((cosine) => reach * Math.sqrt(Math.max(0, 1 - cosine * cosine)));
      for (const side of [-1, 1])
        points.push(middle.map((value, k) => value + side * reaches[k]!) as unknown as Triple);
    }
  }
  return spread(points);
}

function spread(points: readonly Triple[]): Box {
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high: [number, number, number] = [-Infinity, -Infinity, -Infinity];
  for (const point of points) {
    for (const k of [0, 1, 2] as const) {
      low[k] = Math.min(low[k], point[k]);
      high[k] = Math.max(high[k], point[k]);
    }
  }
  return { low, high };
}

function span({ low, high }: Box): number[] {
  return high.map((value, k) => value - low[k]!);
}
