/** A quantity over the time of the run, with a line where the clock stands; a click sets the clock. */

import uPlot from "uplot";
import type { Numbers } from "../answers";
import { element, onResize, themeColour } from "../dom";
import { told } from "../format";
import { across, PLAIN, upright } from "./plot-looks";

export interface TimeChartLooks {
  readonly title: string;
  /** Name of the vertical axis. */
  readonly label: string;
  /** Name of the horizontal axis, empty where that of the plot below stands for both. */
  readonly timeLabel: string;
  /** Name of a colour of the theme. */
  readonly colour: string;
}

/** A level that the quantity is held against. */
export interface Level {
  readonly value: number;
  readonly told: string;
}

export class TimeChart {
  readonly root: HTMLElement;
  readonly #looks: TimeChartLooks;
  readonly #host = element("div", { class: "plot" });
  readonly #note = element("span", { class: "note" });
  readonly #head = element("div", { class: "playhead" });
  readonly #plot: uPlot;
  readonly #seek: (time: number) => void;
  #level: Level | null = null;
  #highest = 1;
  #resting = "";
  #time = 0;

  constructor(looks: TimeChartLooks, seek: (time: number) => void) {
    this.#looks = looks;
    this.#seek = seek;
    const heading = element("header", {}, element("h2", {}, looks.title), this.#note);
    this.root = element("section", { class: "panel chart time-chart", "aria-label": looks.title }, heading, this.#host);
    this.#host.setAttribute("role", "img");
    this.#plot = this.#made();
    this.#plot.over.append(this.#head);
    this.#plot.over.addEventListener("click", (event) => this.#clicked(event));
    onResize(this.#host, (width, height) => {
      this.#plot.setSize({ width, height });
      this.setTime(this.#time);
    });
  }

  /** Shows a history, with the level it is held against; what is higher than `highest` is cut off. */
  show(time: readonly number[], values: Numbers, level: Level | null, highest: number, note: string): void {
    this.#level = level;
    this.#highest = highest > 0 ? highest : 1;
    this.#resting = note;
    this.#note.textContent = note;
    this.#host.setAttribute("aria-label", `${this.#looks.title}: ${note}`);
    const levels = level === null ? [] : time.map(() => level.value);
    this.#plot.setData([time as number[], values as number[], levels]);
    this.setTime(this.#time);
  }

  setTime(time: number): void {
    this.#time = time;
    const place = this.#plot.valToPos(time, "x");
    if (Number.isFinite(place)) this.#head.style.transform = `translateX(${place.toFixed(1)}px)`;
  }

  /** Draws again in the colours of the theme. */
  redraw(): void {
    this.#plot.redraw(false);
  }

  #made(): uPlot {
    const { label, timeLabel, colour } = this.#looks;
    return new uPlot(
      {
        ...PLAIN,
        width: 400,
        height: 120,
        scales: { x: { time: false }, y: { range: () => [0, this.#highest * 1.06] } },
        axes: [across(timeLabel), upright(label)],
        series: [
          {},
          { stroke: () => themeColour(colour), width: 1.5, points: { show: false } },
          { stroke: () => themeColour("vermilion"), width: 1.25, dash: [6, 4], points: { show: false } },
        ],
        hooks: { setCursor: [(plot) => this.#read(plot)], draw: [(plot) => this.#nameLevel(plot)] },
      },
      [[], [], []],
      this.#host,
    );
  }

  /** Tells the value below the pointer. */
  #read(plot: uPlot): void {
    const { idx } = plot.cursor;
    const value = idx === null || idx === undefined ? undefined : plot.data[1]?.[idx];
    const time = idx === null || idx === undefined ? undefined : plot.data[0]?.[idx];
    const found = value !== undefined && time !== undefined;
    this.#note.textContent = found ? `${told(value)} at ${told(time, 4)} s` : this.#resting;
  }

  #nameLevel(plot: uPlot): void {
    if (this.#level === null || this.#level.value > this.#highest * 1.06) return;
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.fillStyle = themeColour("vermilion");
    ctx.font = `${11 * uPlot.pxRatio}px system-ui, sans-serif`;
    ctx.textAlign = "right";
    const place = plot.valToPos(this.#level.value, "y", true);
    const room = place - bbox.top > 14 * uPlot.pxRatio;
    ctx.textBaseline = room ? "bottom" : "top";
    ctx.fillText(this.#level.told, bbox.left + bbox.width - 3, place + (room ? -2 : 3));
    ctx.restore();
  }

  #clicked(event: MouseEvent): void {
    const place = event.clientX - this.#plot.over.getBoundingClientRect().left;
    this.#seek(this.#plot.posToVal(place, "x"));
  }
}
