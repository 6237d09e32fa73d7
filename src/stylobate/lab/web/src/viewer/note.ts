/** Words over the picture: how wide the grid is. */

import type { DrawnMotion } from "./drawn-motion";
import { lengthInWords } from "./lengths";

/** Return what is written over the picture; lengths in metres, or in the unit of a column without scale. */
export function noteOn({ plane }: DrawnMotion, spacing: number, unit = "m"): string {
  const grid = `to scale, grid ${unit === "m" ? lengthInWords(spacing) : `${Number(spacing.toPrecision(3))} ${unit}`}`;
  return plane.incline > 0 ? `${grid}, inclined ${Number(((plane.incline * 180) / Math.PI).toPrecision(3))}°` : grid;
}

export const FONT = "12px system-ui, sans-serif";
const INSET = 10; // px from the corner

export function noteElement(): HTMLElement {
  const note = document.createElement("div");
  Object.assign(note.style, {
    position: "absolute",
    left: `${INSET}px`,
    bottom: `${INSET}px`,
    font: FONT,
    pointerEvents: "none",
  });
  return note;
}

/** Write the same into a picture that is taken along. */
export function paintNote(context: CanvasRenderingContext2D, text: string, colour: string, scale: number): void {
  context.scale(scale, scale);
  context.font = FONT;
  context.fillStyle = colour;
  context.textBaseline = "bottom";
  context.fillText(text, INSET, context.canvas.height / scale - INSET);
}
