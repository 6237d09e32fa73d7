/** How all plots look: axes, grid and lettering in the colours of the theme. */

import type uPlot from "uplot";
import { themeColour } from "../frame/dom";
import { ticks } from "../case/ranges";
import { formatted } from "../frame/format";

/** Values along a curve; null where it has a gap. */
export type Numbers = readonly (number | null)[];

export const LETTERING = '11px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';

/** Room for the numbers and the name of a vertical axis [px]: the same everywhere, so that plots stand in line. */
export const AXIS_WIDTH = 58;

/** The name of an axis; one that changes is asked for whenever the axis is drawn. */
export type Label = string | (() => string);

export function axis(label: Label, looks: uPlot.Axis = {}): uPlot.Axis {
  return {
    ...(label === "" ? {} : { label, labelSize: 16, labelFont: LETTERING, labelGap: 0 }),
    font: LETTERING,
    stroke: () => themeColour("muted"),
    grid: { stroke: () => themeColour("grid"), width: 1 },
    ticks: { stroke: () => themeColour("grid"), width: 1, size: 4 },
    gap: 3,
    values: (_, splits) => splits.map((value) => formatted(value, 6)),
    ...looks,
  };
}

/** How many of the unit that an axis shows are one of the unit of its numbers. */
type Factor = () => number;
const SAME: Factor = () => 1;

/** Returns looks of an axis whose ticks stand at round numbers of the unit that it shows. */
function inUnit(factor: Factor): uPlot.Axis {
  return {
    splits: (_, __, from, to, step) => {
      const unit = factor();
      return ticks(from * unit, to * unit, Math.max(1, Math.floor((to - from) / step))).map((one) => one / unit);
    },
    values: (_, splits) => splits.map((value) => formatted(value * factor(), 6)),
  };
}

export function across(label: Label, factor: Factor = SAME): uPlot.Axis {
  return axis(label, { size: label === "" ? 20 : 22, space: 50, ...(factor === SAME ? {} : inUnit(factor)) });
}

export function upright(label: Label, factor: Factor = SAME): uPlot.Axis {
  return axis(label, { size: AXIS_WIDTH - 16, space: 17, ...(factor === SAME ? {} : inUnit(factor)) });
}

/** What uPlot would add and the page does without: zooming by dragging, its own legend and marks. */
export const PLAIN = {
  legend: { show: false },
  cursor: { show: true, x: true, y: false, points: { show: false }, drag: { setScale: false, x: false, y: false } },
  padding: [8, 10, 0, 0],
  // Whole pixels would make stairs of lines that rise slowly.
  pxAlign: false,
} satisfies Partial<uPlot.Options>;
