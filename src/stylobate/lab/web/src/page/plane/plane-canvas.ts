/** A map or basin on a canvas: cells in the looks of their classes, axes with units, the motion that is shown. */

import type { PlaneAxis, PlaneBegun } from "../server/schema";
import { element, onResize, themeColour } from "../frame/dom";
import { axisLabel, formatted } from "../frame/format";
import { ticks } from "../case/ranges";
import type { Cells } from "./cells";
import { UNKNOWN } from "./cells";
import type { Look, Rgb } from "./looks";
import { rgbOf } from "./looks";

const MARGIN = { left: 62, right: 12, top: 8, bottom: 38 };

export interface PlanePicture {
  readonly axes: PlaneBegun["axes"];
  readonly cells: Cells | null;
  readonly looks: ReadonlyMap<number, Look>;
}

/** Where a cell is chosen, or a value stands. */
export type Place = readonly [x: number, y: number];

export class PlaneCanvas {
  readonly root = element("div", { class: "plane plot" });
  readonly canvas = element("canvas", { tabindex: 0, role: "application", "aria-roledescription": "map" });
  #picture: PlanePicture | null = null;
  #values: Place | null = null;
  #cursor: Place | null = null;
  #width = 0;
  #height = 0;
  #waiting = false;

  constructor(pointed: (cell: Place | null) => void, chosen: (cell: Place) => void) {
    this.root.append(this.canvas);
    this.canvas.addEventListener("pointermove", (event) => pointed(this.#cellAt(event)));
    this.canvas.addEventListener("pointerleave", () => pointed(null));
    this.canvas.addEventListener("click", (event) => {
      const cell = this.#cellAt(event);
      if (cell !== null) chosen(cell);
    });
    this.canvas.addEventListener("keydown", (event) => this.#key(event, pointed, chosen));
    this.canvas.addEventListener("blur", () => this.#setCursor(null));
    onResize(this.root, (width, height) => {
      this.#width = width;
      this.#height = height;
      this.redraw();
    });
  }

  show(picture: PlanePicture | null, values: Place | null): void {
    this.#picture = picture;
    this.#values = values;
    this.redraw();
  }

  /** Draws with the next frame, once however often it is asked for. */
  redraw(): void {
    if (this.#waiting) return;
    this.#waiting = true;
    requestAnimationFrame(() => {
      this.#waiting = false;
      this.#draw();
    });
  }

  /** Returns where the middle of a cell stands in the window [px]. */
  clientPlace([ix, iy]: Place): Place {
    const { left, top } = this.canvas.getBoundingClientRect();
    const { width, height } = this.#room();
    const [nx, ny] = this.#size();
    return [left + MARGIN.left + ((ix + 0.5) / nx) * width, top + MARGIN.top + (1 - (iy + 0.5) / ny) * height];
  }

  #room(): { width: number; height: number } {
    const { left, right, top, bottom } = MARGIN;
    const room = { width: Math.max(this.#width - left - right, 1), height: Math.max(this.#height - top - bottom, 1) };
    return this.#picture === null ? room : roomFor(this.#picture.axes, room);
  }

  #size(): Place {
    const axes = this.#picture?.axes;
    return [axes?.x.values.length ?? 1, axes?.y.values.length ?? 1];
  }

  #cellAt(event: MouseEvent): Place | null {
    if (this.#picture === null) return null;
    const { left, top } = this.canvas.getBoundingClientRect();
    const { width, height } = this.#room();
    const [nx, ny] = this.#size();
    const ix = Math.floor(((event.clientX - left - MARGIN.left) / width) * nx);
    const iy = Math.floor((1 - (event.clientY - top - MARGIN.top) / height) * ny);
    return ix >= 0 && ix < nx && iy >= 0 && iy < ny ? [ix, iy] : null;
  }

  #key(event: KeyboardEvent, pointed: (cell: Place) => void, chosen: (cell: Place) => void): void {
    if (this.#picture === null) return;
    const [nx, ny] = this.#size();
    const [ix, iy] = this.#cursor ?? this.#cellOfValues() ?? [nx >> 1, ny >> 1];
    const wide = event.shiftKey ? 8 : 1;
    const moves: Readonly<Record<string, Place>> = {
      ArrowLeft: [-wide, 0],
      ArrowRight: [wide, 0],
      ArrowDown: [0, -wide],
      ArrowUp: [0, wide],
    };
    const move = moves[event.key];
    if (event.key === "Enter") chosen([ix, iy]);
    else if (move === undefined) return;
    else {
      const cell: Place = [clamp(ix + move[0], nx), clamp(iy + move[1], ny)];
      this.#setCursor(cell);
      pointed(cell);
    }
    event.preventDefault();
    event.stopPropagation(); // the arrows of the page move the clock
  }

  #setCursor(cell: Place | null): void {
    this.#cursor = cell;
    this.redraw();
  }

  #cellOfValues(): Place | null {
    if (this.#picture === null || this.#values === null) return null;
    const { x, y } = this.#picture.axes;
    const [ix, iy] = [share(x, this.#values[0]) * x.values.length, share(y, this.#values[1]) * y.values.length];
    return [clamp(Math.floor(ix), x.values.length), clamp(Math.floor(iy), y.values.length)];
  }

  #draw(): void {
    if (this.#width === 0) return;
    const ratio = window.devicePixelRatio;
    this.canvas.width = Math.round(this.#width * ratio);
    this.canvas.height = Math.round(this.#height * ratio);
    const pen = this.canvas.getContext("2d");
    if (pen === null || this.#picture === null) return;
    if (this.#picture.cells !== null) this.#drawCells(pen, this.#picture.cells, ratio);
    pen.scale(ratio, ratio);
    this.#drawAxes(pen, this.#picture.axes);
    if (this.#values !== null) this.#drawMark(pen, this.#picture.axes, this.#values);
    if (this.#cursor !== null) this.#drawCursor(pen, this.#cursor);
  }

  #drawCells(pen: CanvasRenderingContext2D, cells: Cells, ratio: number): void {
    const { width, height } = this.#room();
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    const image = pen.createImageData(w, h);
    const paints = new Map<number, Paint>();
    for (const [code, look] of this.#picture?.looks ?? [])
      paints.set(code, { look, colour: rgbOf(look.colour), ink: rgbOf(look.ink) });
    for (let py = 0; py < h; py += 1) {
      const iy = cells.height - 1 - Math.floor((py / h) * cells.height);
      for (let px = 0; px < w; px += 1) {
        const code = cells.at(Math.floor((px / w) * cells.width), iy);
        const paint = code === UNKNOWN ? undefined : paints.get(code);
        if (paint === undefined) continue;
        const inked = paint.look.texture?.(Math.floor(px / ratio), Math.floor(py / ratio)) ?? false;
        const [r, g, b] = inked ? paint.ink : paint.colour;
        const at = 4 * (py * w + px);
        image.data[at] = r;
        image.data[at + 1] = g;
        image.data[at + 2] = b;
        image.data[at + 3] = 255;
      }
    }
    pen.putImageData(image, Math.round(MARGIN.left * ratio), Math.round(MARGIN.top * ratio));
  }

  #drawAxes(pen: CanvasRenderingContext2D, axes: PlaneBegun["axes"]): void {
    const { width, height } = this.#room();
    const { left, top } = MARGIN;
    pen.font = "11px system-ui, sans-serif";
    pen.strokeStyle = themeColour("line");
    pen.fillStyle = themeColour("muted");
    pen.strokeRect(left - 0.5, top - 0.5, width + 1, height + 1);
    pen.textAlign = "center";
    for (const value of ticksOf(axes.x, width / 70)) {
      const x = left + share(axes.x, value) * width;
      pen.fillRect(x - 0.5, top + height, 1, 4);
      pen.fillText(formatted(value, 6), x, top + height + 15);
    }
    pen.fillText(axisLabel(axes.x.name, axes.x.units ?? ""), left + width / 2, top + height + 32);
    pen.textAlign = "right";
    for (const value of ticksOf(axes.y, height / 36)) {
      const y = top + (1 - share(axes.y, value)) * height;
      pen.fillRect(left - 4, y - 0.5, 4, 1);
      pen.fillText(formatted(value, 6), left - 7, y + 4);
    }
    pen.textAlign = "center";
    pen.translate(12, top + height / 2);
    pen.rotate(-Math.PI / 2);
    pen.fillText(axisLabel(axes.y.name, axes.y.units ?? ""), 0, 0);
    pen.rotate(Math.PI / 2);
    pen.translate(-12, -top - height / 2);
  }

  /** Marks the values of the motion that is shown: a ring that is seen on any colour. */
  #drawMark(pen: CanvasRenderingContext2D, axes: PlaneBegun["axes"], [x, y]: Place): void {
    const [sx, sy] = [share(axes.x, x), share(axes.y, y)];
    if (sx < 0 || sx > 1 || sy < 0 || sy > 1) return;
    const { width, height } = this.#room();
    const [px, py] = [MARGIN.left + sx * width, MARGIN.top + (1 - sy) * height];
    for (const [colour, thickness] of [
      ["#000000", 5],
      ["#ffffff", 2.5],
    ] as const) {
      pen.strokeStyle = colour;
      pen.lineWidth = thickness;
      pen.beginPath();
      pen.arc(px, py, 7, 0, 2 * Math.PI);
      pen.moveTo(px - 11, py);
      pen.lineTo(px - 7, py);
      pen.moveTo(px + 7, py);
      pen.lineTo(px + 11, py);
      pen.moveTo(px, py - 11);
      pen.lineTo(px, py - 7);
      pen.moveTo(px, py + 7);
      pen.lineTo(px, py + 11);
      pen.stroke();
    }
    pen.lineWidth = 1;
  }

  #drawCursor(pen: CanvasRenderingContext2D, [ix, iy]: Place): void {
    const { width, height } = this.#room();
    const [nx, ny] = this.#size();
    const [w, h] = [width / nx, height / ny];
    const [x, y] = [MARGIN.left + ix * w, MARGIN.top + (ny - 1 - iy) * h];
    for (const [colour, room] of [
      ["#000000", 2.5],
      ["#ffffff", 1],
    ] as const) {
      pen.strokeStyle = colour;
      pen.lineWidth = 1.5;
      pen.strokeRect(x - room, y - room, w + 2 * room, h + 2 * room);
    }
  }
}

interface Paint {
  readonly look: Look;
  readonly colour: Rgb;
  readonly ink: Rgb;
}

function clamp(index: number, length: number): number {
  return Math.min(Math.max(index, 0), length - 1);
}

interface Room {
  readonly width: number;
  readonly height: number;
}

/** Returns the part of a room in which axes of one kind are drawn to one scale; other axes take all of it. */
export function roomFor({ x, y }: PlaneBegun["axes"], { width, height }: Room): Room {
  if (x.units !== y.units || x.name.replace(/_x$/, "") !== y.name.replace(/_y$/, "")) return { width, height };
  const scale = Math.min(width / span(x), height / span(y));
  return { width: scale * span(x), height: scale * span(y) };
}

/** Returns the length of an axis, to the edges of its cells. */
function span({ values }: PlaneAxis): number {
  const [first, last] = [values[0] ?? 0, values.at(-1) ?? 1];
  return ((last - first) * values.length) / Math.max(values.length - 1, 1) || 1;
}

/** Returns where a value stands along an axis, 0 to 1; cells reach half a step beyond their values. */
export function share({ values }: PlaneAxis, value: number): number {
  const [first, last] = [values[0] ?? 0, values.at(-1) ?? 1];
  const half = (last - first) / Math.max(values.length - 1, 1) / 2;
  return (value - first + half) / (last - first + 2 * half);
}

function ticksOf({ values }: PlaneAxis, number: number): readonly number[] {
  return ticks(values[0] ?? 0, values.at(-1) ?? 1, Math.max(number, 2));
}
