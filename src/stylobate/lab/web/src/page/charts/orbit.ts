/** The path of the tilt vector, seen from above, within the circle |θ| = c beyond which nothing holds the column. */

import type { DrawnMotion } from "../../viewer/drawn-motion";
import { element, onResize, themeColour } from "../frame/dom";
import { formatted } from "../frame/format";
import { ticks } from "../case/ranges";

/** In units of c: what falls is seen to leave, and what came before is still seen. */
const FARTHEST = 2;

const MARGIN = { left: 46, right: 10, top: 8, bottom: 34 };

export class OrbitChart {
  readonly root: HTMLElement;
  readonly #canvas = element("canvas", { role: "img" });
  readonly #dot = element("div", { class: "orbit-dot", hidden: true });
  #motion: DrawnMotion | null = null;
  #width = 0;
  #height = 0;
  #reach = 1;
  #time = 0;

  constructor() {
    this.root = element("div", { class: "orbit plot" }, this.#canvas, this.#dot);
    onResize(this.root, (width, height) => {
      this.#width = width;
      this.#height = height;
      this.redraw();
    });
  }

  show(motion: DrawnMotion): void {
    this.#motion = motion;
    const c = motion.column.slenderness;
    const farthest = motion.tilt.reduce((most, [x, y]) => Math.max(most, Math.hypot(x, y) / c), 0);
    this.#reach = Math.min(Math.max(1, farthest), FARTHEST) * 1.08;
    this.#canvas.setAttribute("aria-label", `Path of the tilt vector; it reaches ${formatted(farthest)} c`);
    this.redraw();
  }

  setTime(time: number): void {
    this.#time = time;
    const motion = this.#motion;
    if (motion === null || this.#width === 0) return;
    const [x, y] = tiltAt(motion, time);
    const [px, py] = this.#place(x / motion.column.slenderness, y / motion.column.slenderness);
    this.#dot.hidden = Math.max(Math.abs(x), Math.abs(y)) > this.#reach * motion.column.slenderness;
    this.#dot.style.transform = `translate(${px.toFixed(1)}px, ${py.toFixed(1)}px)`;
  }

  redraw(): void {
    if (this.#width === 0) return;
    const ratio = window.devicePixelRatio;
    this.#canvas.width = Math.round(this.#width * ratio);
    this.#canvas.height = Math.round(this.#height * ratio);
    const pen = this.#canvas.getContext("2d");
    if (pen === null) return;
    pen.scale(ratio, ratio);
    this.#drawAxes(pen);
    this.#drawRim(pen);
    if (this.#motion !== null) this.#drawPath(pen, this.#motion);
    this.setTime(this.#time);
  }

  /** Returns where a tilt in units of c stands [px]: as long in both directions. */
  #place(x: number, y: number): [number, number] {
    const { left, right, top, bottom } = MARGIN;
    const [width, height] = [this.#width - left - right, this.#height - top - bottom];
    const scale = Math.min(width, height) / 2 / this.#reach;
    return [left + width / 2 + x * scale, top + height / 2 - y * scale];
  }

  #drawAxes(pen: CanvasRenderingContext2D): void {
    const reach = this.#reach;
    const [left, bottom] = this.#place(-reach, -reach);
    const [right, top] = this.#place(reach, reach);
    pen.font = "11px system-ui, sans-serif";
    pen.strokeStyle = themeColour("grid");
    pen.fillStyle = themeColour("muted");
    pen.beginPath();
    for (const value of ticks(-reach, reach, 5)) {
      const [x, y] = this.#place(value, value);
      pen.moveTo(x, top);
      pen.lineTo(x, bottom);
      pen.moveTo(left, y);
      pen.lineTo(right, y);
      pen.textAlign = "center";
      pen.fillText(formatted(value), x, bottom + 13);
      pen.textAlign = "right";
      pen.fillText(formatted(value), left - 5, y + 4);
    }
    pen.stroke();
    pen.textAlign = "center";
    pen.fillText("θx/c", (left + right) / 2, bottom + 28);
    pen.save();
    pen.translate(left - 34, (top + bottom) / 2);
    pen.rotate(-Math.PI / 2);
    pen.fillText("θy/c", 0, 0);
    pen.restore();
  }

  #drawRim(pen: CanvasRenderingContext2D): void {
    const [x, y] = this.#place(0, 0);
    const [edge] = this.#place(1, 0);
    pen.strokeStyle = themeColour("vermilion");
    pen.setLineDash([6, 4]);
    pen.lineWidth = 1.25;
    pen.beginPath();
    pen.arc(x, y, edge - x, 0, 2 * Math.PI);
    pen.stroke();
    pen.setLineDash([]);
    pen.fillStyle = themeColour("vermilion");
    pen.textAlign = "left";
    pen.fillText("|θ| = c", x + (edge - x) * 0.72 + 3, y - (edge - x) * 0.72 - 3);
  }

  #clip(pen: CanvasRenderingContext2D): void {
    const [left, bottom] = this.#place(-this.#reach, -this.#reach);
    const [right, top] = this.#place(this.#reach, this.#reach);
    pen.beginPath();
    pen.rect(left, top, right - left, bottom - top);
    pen.clip();
  }

  #drawPath(pen: CanvasRenderingContext2D, motion: DrawnMotion): void {
    const c = motion.column.slenderness;
    pen.strokeStyle = themeColour("blue");
    pen.lineWidth = 1.25;
    pen.lineJoin = "round";
    pen.save();
    this.#clip(pen);
    pen.beginPath();
    for (const [tx, ty] of motion.tilt) pen.lineTo(...this.#place(tx / c, ty / c));
    pen.stroke();
    pen.restore();
    const [startX, startY] = motion.tilt[0] ?? [0, 0];
    pen.fillStyle = themeColour("panel");
    pen.beginPath();
    pen.arc(...this.#place(startX / c, startY / c), 3, 0, 2 * Math.PI);
    pen.fill();
    pen.stroke();
  }
}

/** Returns the tilt at a time, linear between the samples. */
export function tiltAt(motion: DrawnMotion, time: number): readonly [number, number] {
  const { time: times, tilt } = motion;
  const after = indexAfter(times, time);
  const [first, second] = [tilt[after - 1], tilt[after]];
  if (first === undefined || second === undefined) return tilt.at(after === 0 ? 0 : -1) ?? [0, 0];
  const [from, to] = [times[after - 1] ?? 0, times[after] ?? 1];
  const share = (time - from) / (to - from);
  return [first[0] + share * (second[0] - first[0]), first[1] + share * (second[1] - first[1])];
}

/** Returns the index of the first of the rising `times` that is later than `time`. */
export function indexAfter(times: readonly number[], time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] ?? Infinity) > time) high = middle;
    else low = middle + 1;
  }
  return low;
}
