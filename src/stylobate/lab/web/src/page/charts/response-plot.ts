/** One of the two plots of the frequency response: amplitude or phase over angular frequency. */

import uPlot from "uplot";
import type { Pair } from "../../viewer/index";
import type { ExactOrbits, OrbitFamily } from "../server/schema";
import type { Numbers } from "./plot-looks";
import { themeColour } from "../frame/dom";
import { formatted, frequencyText } from "../frame/format";
import { frequencyScaling, isTaught, tiltScaling } from "../frame/units";
import type { Label } from "./plot-looks";
import { across, PLAIN, upright } from "./plot-looks";
import type { ResponseLine } from "./response-lines";
import { continuous } from "./response-lines";

export type Quantity = "amplitude" | "phase";

export interface ResponsePicture {
  readonly frequency: readonly number[];
  readonly lines: readonly ResponseLine[];
  readonly backbone: Numbers;
  readonly critical: readonly number[];
  /** Whether the curves do not say what this column does: they are of another model, or exact orbits are shown. */
  readonly pale: boolean;
  readonly exact: ExactOrbits | null;
  readonly slenderness: number;
  readonly range: readonly [number, number];
  readonly height: number;
}

/** An orbit that a run can start on: its frequency and its state at t = 0. */
export interface ExactOrbit {
  readonly frequency: number;
  readonly tilt: Pair;
  readonly tilt_rate: Pair;
}

/** Curves, of every case: two senses, two branches, stable or not; then the backbone. */
const MOST_LINES = 8;

export class ResponsePlot {
  readonly plot: uPlot;
  readonly #quantity: Quantity;
  #picture: ResponsePicture | null = null;
  /** The frequency at which the marker stands; labels make way for it. */
  #marked: number | null = null;
  /** Where the labels were written. */
  #places = "";

  /** `drawn` hears of each new drawing: the room that is left for the curves depends on the lettering of the axes. */
  constructor(
    quantity: Quantity,
    host: HTMLElement,
    labels: readonly [across: Label, upright: Label],
    drawn: () => void = () => undefined,
  ) {
    this.#quantity = quantity;
    const lines = Array.from({ length: MOST_LINES }, (_, i): uPlot.Series => this.#lineLooks(i));
    this.plot = new uPlot(
      {
        ...PLAIN,
        padding: [8, () => this.#roomAtEnd(), 0, 0],
        width: 400,
        height: 200,
        scales: {
          x: { time: false, range: () => [...(this.#picture?.range ?? [0, 1])] },
          y: { range: (_, low, high) => this.#limits(low, high) },
        },
        axes: [across(labels[0], () => frequencyScaling().factor), upright(labels[1], () => this.#tiltUnit())],
        series: [{}, ...lines, this.#backboneLooks()],
        hooks: { drawAxes: [(plot) => this.#drawCritical(plot)], draw: [(plot) => this.#drawExact(plot), drawn] },
        cursor: { show: false },
      },
      [[], ...Array.from({ length: MOST_LINES + 1 }, () => [])],
      host,
    );
  }

  show(picture: ResponsePicture): void {
    this.#picture = picture;
    const empty = picture.frequency.map(() => null);
    const lines = Array.from({ length: MOST_LINES }, (_, i) => picture.lines[i]?.[this.#quantity] ?? empty);
    const backbone = this.#quantity === "amplitude" && !isTaught() ? picture.backbone : empty;
    this.plot.setData([picture.frequency as number[], ...([...lines, backbone] as (number | null)[][])]);
  }

  /** Returns how many of the unit of tilts are shown for one c, in which they are drawn. */
  #tiltUnit(): number {
    const c = this.#picture?.slenderness ?? 1;
    return this.#quantity === "phase" ? 1 : c * tiltScaling(c).factor;
  }

  /** Takes the frequency at which the marker stands, and writes labels that it would cross on their other side. */
  showMarker(frequency: number | null): void {
    this.#marked = frequency;
    if (this.#quantity === "amplitude" && this.#places !== this.#placesOf(this.#critical())) this.plot.redraw(false);
  }

  #placesOf(lines: readonly { readonly place: LabelPlace }[]): string {
    return lines.map(({ place }) => `${place.align} ${place.at}`).join();
  }

  /** Returns the lines of the critical frequencies in the plot, with their labels. */
  #critical(): readonly { readonly x: number; readonly text: string; readonly place: LabelPlace }[] {
    const { ctx, bbox } = this.plot;
    ctx.font = CRITICAL_FONT();
    const [from, to] = [bbox.left, bbox.left + bbox.width];
    const marked = this.#marked === null ? null : this.plot.valToPos(this.#marked, "x", true);
    return (this.#picture?.critical ?? []).flatMap((frequency) => {
      const x = this.plot.valToPos(frequency, "x", true);
      if (!(x >= from && x <= to)) return [];
      const value = frequencyText(frequency);
      const texts = [`critical ${value}`, value].map((text) => ({ text, width: ctx.measureText(text).width }));
      return [{ x, ...labelBeside(x, texts, [from, to], marked, LABEL_GAP * uPlot.pxRatio) }];
    });
  }

  /** The looks are asked for when drawing: which line stands at which place changes with the case. */
  #lineLooks(index: number): uPlot.Series {
    const stable = index % 2 === 0; // as `linesOf` has them
    const colour = (): string =>
      themeColour(this.#picture?.lines[index]?.sense === "clockwise" ? "vermilion" : "blue") +
      (this.#picture?.pale === true ? PALE : "");
    return {
      stroke: colour,
      width: stable ? 2.8 : 1,
      ...(stable ? {} : { dash: [5, 4] }),
      points: { show: false },
      spanGaps: false,
    };
  }

  /** Returns the room to the right [px]: half of the last number of the axis reaches beyond the plot. */
  #roomAtEnd(): number {
    const last = formatted(this.#picture?.range[1] ?? 1, 6);
    return Math.max(10, Math.ceil((last.length * DIGIT) / 2));
  }

  #backboneLooks(): uPlot.Series {
    return { stroke: () => themeColour("muted"), width: 1, dash: [1, 4], points: { show: false } };
  }

  #limits(low: number | null, high: number | null): [number, number] {
    if (this.#quantity === "amplitude") return [0, this.#picture?.height ?? 1];
    if (low === null || high === null) return [-Math.PI, 0];
    const room = Math.max((high - low) * 0.06, 0.05);
    return [low - room, high + room];
  }

  #drawCritical(plot: uPlot): void {
    const { ctx, bbox } = plot;
    const ratio = uPlot.pxRatio;
    ctx.save();
    ctx.strokeStyle = ctx.fillStyle = themeColour("muted");
    ctx.setLineDash([2 * ratio, 3 * ratio]);
    const lines = this.#critical();
    this.#places = this.#placesOf(lines);
    for (const { x, text, place } of lines) {
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      if (this.#quantity === "phase") continue;
      // Beside the top of its line: unstable to the left and stable to the right.
      ctx.textBaseline = "top";
      ctx.textAlign = place.align;
      const { width } = ctx.measureText(text);
      ctx.globalAlpha = 0.8; // a curve may run below it
      ctx.fillStyle = themeColour("panel");
      ctx.fillRect(place.align === "left" ? place.at : place.at - width, bbox.top, width, 15 * ratio);
      ctx.globalAlpha = 1;
      ctx.fillStyle = themeColour("muted");
      ctx.fillText(text, place.at, bbox.top + 2 * ratio);
    }
    ctx.restore();
  }

  /** Returns the exact orbit whose dot lies nearest to a place in the window, if one is within reach. */
  orbitAt(clientX: number, clientY: number): ExactOrbit | null {
    const { left, top } = this.plot.over.getBoundingClientRect();
    const { exact, slenderness } = this.#picture ?? { exact: null, slenderness: 1 };
    let [nearest, least]: [ExactOrbit | null, number] = [null, REACH];
    for (const family of exact?.families ?? []) {
      const values = this.#valuesOf(family, slenderness);
      family.angular_frequency.forEach((frequency, i) => {
        const [value, tilt, tilt_rate] = [values[i], family.tilt[i], family.tilt_rate[i]];
        if (frequency === null || typeof value !== "number" || !tilt || !tilt_rate) return;
        const [x, y] = [this.plot.valToPos(frequency, "x"), this.plot.valToPos(value, "y")];
        const distance = Math.hypot(clientX - left - x, clientY - top - y);
        if (distance < least) [nearest, least] = [{ frequency, tilt, tilt_rate }, distance];
      });
    }
    return nearest;
  }

  /** Returns what of a family this plot draws: its phase, or its mean tilt in units of c. */
  #valuesOf(family: OrbitFamily, slenderness: number): Numbers {
    if (this.#quantity === "phase") return continuous(family.phase);
    return family.mean_tilt.map((value) => (value === null ? null : value / slenderness));
  }

  #drawExact(plot: uPlot): void {
    const { exact, slenderness } = this.#picture ?? { exact: null, slenderness: 1 };
    if (exact === null) return;
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.setLineDash([]); // the curves before have left their dashes
    for (const family of exact.families) {
      const values = this.#valuesOf(family, slenderness);
      let last: readonly [number, number, boolean] | null = null;
      family.angular_frequency.forEach((frequency, i) => {
        const value = values[i];
        if (frequency === null || value === null || value === undefined) return;
        const [x, y] = [plot.valToPos(frequency, "x", true), plot.valToPos(value, "y", true)];
        const stable = family.stable[i] === true;
        // Orbits are found close together where the branch bends; dots that touch would hide the curves.
        if (last !== null && last[2] === stable && Math.hypot(x - last[0], y - last[1]) < APART * uPlot.pxRatio) return;
        last = [x, y, stable];
        drawDot(plot, x, y, stable);
      });
    }
    for (const one of this.#quantity === "amplitude" ? exact.bifurcations : []) {
      if (one.mean_tilt !== null) drawDiamond(plot, one.angular_frequency, one.mean_tilt / slenderness);
    }
    ctx.restore();
  }
}

/** The opacity, in hexadecimal digits, of curves that do not count. */
const PALE = "60";

/** The width of a digit on an axis [px], rounded up for broad letters. */
const DIGIT = 8;

/** How far from a dot a click may be [px]. */
const REACH = 7;

/** The least distance of two dots [px]. */
const APART = 9;

const CRITICAL_FONT = (): string => `${12 * uPlot.pxRatio}px system-ui, sans-serif`;

/** Between a line and its label, and between a label and the marker [px]. */
const LABEL_GAP = 5;

/** Where a label begins or ends, and which of the two. */
export interface LabelPlace {
  readonly at: number;
  readonly align: "left" | "right";
}

/** Returns the first of the texts that has room beside the line at `x`, where the marker does not cross it. */
export function labelBeside(
  x: number,
  texts: readonly { readonly text: string; readonly width: number }[],
  [from, to]: readonly [number, number],
  marked: number | null,
  gap: number,
): { readonly text: string; readonly place: LabelPlace } {
  const right: LabelPlace = { at: x + gap, align: "left" };
  const left: LabelPlace = { at: x - gap, align: "right" };
  const free = ({ at, align }: LabelPlace, width: number): boolean => {
    const [low, high] = align === "left" ? [at, at + width] : [at - width, at];
    return low >= from && high <= to && !(marked !== null && marked > low - gap && marked < high + gap);
  };
  const found = texts.flatMap(({ text, width }) =>
    [right, left].filter((place) => free(place, width)).map((place) => ({ text, place })),
  );
  return found[0] ?? { text: texts.at(-1)!.text, place: x < (from + to) / 2 ? right : left };
}

function drawDot(plot: uPlot, x: number, y: number, stable: boolean): void {
  const { ctx } = plot;
  const ratio = uPlot.pxRatio;
  ctx.beginPath();
  ctx.arc(x, y, 2.4 * ratio, 0, 2 * Math.PI);
  ctx.fillStyle = themeColour(stable ? "green" : "panel");
  ctx.strokeStyle = themeColour("green");
  ctx.lineWidth = 1.1 * ratio;
  ctx.fill();
  ctx.stroke();
}

function drawDiamond(plot: uPlot, frequency: number, value: number): void {
  const { ctx } = plot;
  const size = 5.5 * uPlot.pxRatio;
  const [x, y] = [plot.valToPos(frequency, "x", true), plot.valToPos(value, "y", true)];
  ctx.beginPath();
  ctx.moveTo(x, y - size);
  ctx.lineTo(x + size, y);
  ctx.lineTo(x, y + size);
  ctx.lineTo(x - size, y);
  ctx.closePath();
  ctx.fillStyle = themeColour("purple");
  ctx.strokeStyle = themeColour("panel");
  ctx.lineWidth = uPlot.pxRatio;
  ctx.fill();
  ctx.stroke();
}
