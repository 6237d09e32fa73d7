/** A quantity over the time of the run, with a line where the clock stands; a click sets the clock. */

import uPlot from "uplot";
import { choice, element, onResize, themeColour } from "../frame/dom";
import { formatted, withUnit } from "../frame/format";
import { type Envelope, envelopeOf } from "./envelope";
import type { History, HistoryName, SecondHistory } from "./history-kinds";
import { HISTORIES, isHistoryName } from "./history-kinds";
import type { Variations } from "../server/schema";
import type { Label, Numbers } from "./plot-looks";
import { across, PLAIN, upright } from "./plot-looks";

export interface TimeChartHearing {
  readonly seek: (time: number) => void;
  readonly chosen: (name: HistoryName) => void;
}

/** Tilts of many runs [rad], those that overturn in another colour; drawn times a factor, up to a tilt [rad]. */
export type Cloud = Pick<Variations, "times" | "tilts" | "outcomes"> & {
  readonly factor: number;
  readonly top: number;
};

/** What is drawn with a history: small variations of its run, and the same quantity of a second run. */
export interface Company {
  readonly cloud: Cloud | null;
  readonly second: SecondHistory | null;
  /** Until when the longer of the runs lasts [s]. */
  readonly end: number;
}

/** Widths of a line alone, and of the first of two [px]. */
const [ALONE, FIRST] = [1.5, 2.25];

/** Opacity of a band. */
const BAND = 0.3;

const LINEAR = uPlot.paths.linear!();

/** Opacity of one line of a cloud. */
const THIN = 0.25;

/** Room above and below what is drawn, in parts of its height. */
const ROOM = 0.06;

export class TimeChart {
  readonly root: HTMLElement;
  readonly #hearing: TimeChartHearing;
  readonly #kind: HTMLSelectElement;
  readonly #host = element("div", { class: "plot", role: "img" });
  readonly #note = element("span", { class: "note" });
  /** Which of two lines is which. */
  readonly #legend = element("ul", { class: "legend" });
  readonly #head = element("div", { class: "playhead" });
  readonly #plot: uPlot;
  #history: History | null = null;
  #cloud: Cloud | null = null;
  #second: SecondHistory | null = null;
  #end = 0;
  /** The bands of runs whose swings lie too close together to be drawn one by one. */
  #bands: { readonly first: Envelope | null; readonly second: Envelope | null } = { first: null, second: null };
  #offered = "";
  #time = 0;

  /** `timeLabel` is empty where that of the plot below stands for both. */
  constructor(name: string, timeLabel: Label, hearing: TimeChartHearing) {
    this.#hearing = hearing;
    this.#kind = choice([], { class: "title", "aria-label": name }, (value) => {
      if (isHistoryName(value)) hearing.chosen(value);
    });
    const heading = element("header", {}, this.#kind, this.#legend, this.#note);
    this.root = element("section", { class: "panel chart time-chart", "aria-label": name }, heading, this.#host);
    this.#plot = this.#made(timeLabel);
    this.#plot.over.append(this.#head);
    this.#plot.over.addEventListener("click", (event) => this.#clicked(event));
    onResize(this.#host, (width, height) => {
      this.#plot.setSize({ width, height });
      if (this.#history !== null) this.#draw(this.#history);
      this.setTime(this.#time);
    });
  }

  /** Shows a history, one of those that are offered, in its company. */
  show(history: History, offered: readonly HistoryName[], { cloud, second, end }: Company): void {
    this.#history = history;
    this.#end = end;
    this.#cloud = cloud;
    this.#second = second;
    this.#plot.series[1]!.width = second === null ? ALONE : FIRST;
    this.#showLegend();
    this.#offer(offered);
    this.#kind.value = history.name;
    this.#draw(history);
    this.setTime(this.#time);
  }

  /** What stands beside the quantity: how large it gets, of both runs. */
  get #largest(): string {
    const note = this.#history?.note ?? "";
    const { first, second } = this.#bands;
    if (this.#second === null) return first === null ? note : `${note}; band: range of the swings`;
    return first === null && second === null
      ? `${note}; dashed: ${this.#second.history.note}`
      : "bands: range of the swings";
  }

  /** Draws the run, as a band where its swings lie too close together at the width of the plot. */
  #draw(history: History): void {
    const width = this.#plot.over.clientWidth;
    const end = this.#span(null)[1];
    const bandOf = (times: readonly number[], values: Numbers): Envelope | null =>
      envelopeOf(times, values, (width * ((times.at(-1) ?? 0) - (times[0] ?? 0))) / end);
    this.#bands = {
      first: bandOf(history.time, history.values),
      second: this.#second && bandOf(this.#second.history.time, this.#second.history.values),
    };
    this.#note.textContent = this.#largest;
    this.#host.setAttribute("aria-label", `${HISTORIES[history.name]}: ${this.#largest}`);
    this.#plot.setData([history.time as number[], history.values as number[]]);
  }

  #showLegend(): void {
    const [first = "", other = ""] = this.#second?.labels ?? [];
    const key = (look: string, text: string): HTMLElement =>
      element("li", {}, element("span", { class: `key ${look}`, "aria-hidden": "true" }), text);
    const entries = this.#second === null ? [] : [key(this.#history?.colour ?? "blue", first), key("dashed", other)];
    this.#legend.replaceChildren(...entries);
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

  #offer(offered: readonly HistoryName[]): void {
    const listed = offered.join();
    if (listed === this.#offered) return; // an open list keeps its place
    this.#offered = listed;
    this.#kind.replaceChildren(...offered.map((name) => element("option", { value: name }, HISTORIES[name])));
  }

  /** A run that is drawn as a band has no line. */
  readonly #paths: uPlot.Series.PathBuilder = (plot, ...which) =>
    this.#bands.first === null ? LINEAR(plot, ...which) : null;

  #made(timeLabel: Label): uPlot {
    return new uPlot(
      {
        ...PLAIN,
        width: 400,
        height: 120,
        scales: {
          x: { time: false, range: (_, from) => this.#span(from) },
          y: { range: () => this.#limits() },
        },
        axes: [across(timeLabel), { ...upright(" "), label: () => this.#history?.label ?? "" }],
        series: [
          {},
          {
            stroke: () => themeColour(this.#history?.colour ?? "blue"),
            width: ALONE,
            points: { show: false },
            paths: this.#paths,
          },
        ],
        hooks: {
          setCursor: [(plot) => this.#read(plot)],
          drawAxes: [(plot) => this.#drawCloud(plot)],
          draw: [(plot) => this.#drawBand(plot), (plot) => this.#drawSecond(plot), (plot) => this.#drawLevel(plot)],
        },
      },
      [[], []],
      this.#host,
    );
  }

  /** Returns from when to when the plot reaches: as long as the longer run. */
  #span(from: number | null): [number, number] {
    const start = from ?? 0;
    return [start, this.#end > start ? this.#end : start + 1];
  }

  #limits(): [number, number] {
    const [own, other] = [this.#history?.limits ?? [0, 1], this.#second?.history.limits ?? []];
    const low = Math.min(own[0], other[0] ?? own[0]);
    const high = Math.max(own[1], other[1] ?? own[1], this.#cloudTop());
    if (!(high > low)) return [low, low + 1];
    const room = (high - low) * ROOM;
    return [low < 0 ? low - room : low, high + room];
  }

  /** Returns the largest tilt of the cloud, as far as columns come back from it. */
  #cloudTop(): number {
    if (this.#cloud === null) return 0;
    const { tilts, factor, top } = this.#cloud;
    return Math.min(Math.max(...tilts.flatMap((one) => one.map((value) => value ?? 0))), top) * factor;
  }

  /** Shows the value below the pointer. */
  #read(plot: uPlot): void {
    const { idx } = plot.cursor;
    const value = idx === null || idx === undefined ? undefined : plot.data[1]?.[idx];
    const time = idx === null || idx === undefined ? undefined : plot.data[0]?.[idx];
    const found = value !== undefined && time !== undefined;
    this.#note.textContent = found ? `${formatted(value)} at ${withUnit(time, "s", 4)}` : this.#largest;
  }

  #drawCloud(plot: uPlot): void {
    if (this.#cloud === null) return;
    const { times, tilts, outcomes, factor } = this.#cloud;
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.globalAlpha = THIN;
    ctx.lineWidth = uPlot.pxRatio;
    tilts.forEach((tilt, i) => {
      ctx.strokeStyle = themeColour(outcomes[i] === "OVERTURNED" ? "vermilion" : "blue");
      ctx.beginPath();
      tilt.forEach((value, k) => {
        const time = times[i]?.[k];
        if (value === null || time === null || time === undefined) return;
        ctx.lineTo(plot.valToPos(time, "x", true), plot.valToPos(value * factor, "y", true));
      });
      ctx.stroke();
    });
    ctx.restore();
  }

  #drawBand(plot: uPlot): void {
    const band = this.#bands.first;
    if (band === null) return;
    const { ctx, bbox } = plot;
    const colour = themeColour(this.#history?.colour ?? "blue");
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = ctx.strokeStyle = colour;
    ctx.globalAlpha = BAND;
    trace(plot, [...band.time, ...band.time.toReversed()], [...band.high, ...band.low.toReversed()]);
    ctx.fill();
    ctx.globalAlpha = 1;
    ctx.lineWidth = (this.#second === null ? ALONE : FIRST) * uPlot.pxRatio;
    for (const edge of [band.low, band.high]) {
      trace(plot, band.time, edge);
      ctx.stroke();
    }
    ctx.restore();
  }

  /** Draws the second run dashed, over the bold line of the first. */
  #drawSecond(plot: uPlot): void {
    if (this.#second === null) return;
    const { history } = this.#second;
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.lineWidth = 1.25 * uPlot.pxRatio;
    ctx.setLineDash([5 * uPlot.pxRatio, 3 * uPlot.pxRatio]);
    ctx.strokeStyle = themeColour("ink");
    const band = this.#bands.second;
    const lines =
      band === null
        ? [[history.time, history.values] as const]
        : [[band.time, band.low] as const, [band.time, band.high] as const];
    for (const [times, values] of lines) {
      trace(plot, times, values);
      ctx.stroke();
    }
    ctx.restore();
  }

  #drawLevel(plot: uPlot): void {
    const level = this.#history?.level ?? null;
    const [low, high] = this.#limits();
    if (level === null || level.value > high || level.value < low) return;
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.font = `${11 * uPlot.pxRatio}px system-ui, sans-serif`;
    ctx.textAlign = "right";
    const place = plot.valToPos(level.value, "y", true);
    ctx.lineWidth = 1.25 * uPlot.pxRatio;
    ctx.setLineDash([6 * uPlot.pxRatio, 4 * uPlot.pxRatio]);
    ctx.strokeStyle = themeColour("vermilion");
    ctx.beginPath();
    ctx.moveTo(bbox.left, place);
    ctx.lineTo(bbox.left + bbox.width, place);
    ctx.stroke();
    const room = place - bbox.top > 14 * uPlot.pxRatio;
    ctx.textBaseline = room ? "bottom" : "top";
    const [right, line] = [bbox.left + bbox.width - 3, place + (room ? -2 : 3)];
    const [width, height] = [ctx.measureText(level.label).width + 4, 13 * uPlot.pxRatio];
    ctx.globalAlpha = 0.8; // the curve may run below it
    ctx.fillStyle = themeColour("panel");
    ctx.fillRect(right - width + 2, room ? line - height : line, width, height);
    ctx.globalAlpha = 1;
    ctx.fillStyle = themeColour("vermilion");
    ctx.fillText(level.label, right, line);
    ctx.restore();
  }

  #clicked(event: MouseEvent): void {
    const place = event.clientX - this.#plot.over.getBoundingClientRect().left;
    this.#hearing.seek(this.#plot.posToVal(place, "x"));
  }
}

/** Makes a line through values over time the path of the pen, broken where there are none. */
function trace(plot: uPlot, time: readonly number[], values: Numbers): void {
  plot.ctx.beginPath();
  let down = false;
  values.forEach((value, i) => {
    if (value === null) {
      down = false;
      return;
    }
    const [x, y] = [plot.valToPos(time[i]!, "x", true), plot.valToPos(value, "y", true)];
    if (down) plot.ctx.lineTo(x, y);
    else plot.ctx.moveTo(x, y);
    down = true;
  });
}
