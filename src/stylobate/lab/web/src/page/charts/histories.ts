/** Two quantities of the run over time: tilt and demand on the contact, or what the reader chooses. */

import type { Variations } from "../server/schema";
import { element } from "../frame/dom";
import { axisLabel } from "../frame/format";
import { tiltScaling } from "../frame/units";
import type { HistoryName, HistoryPair, RunShown, SecondRun } from "./history-kinds";
import { chosenHistories, historyOf, offeredHistories, secondHistory } from "./history-kinds";
import { TimeChart } from "./time-chart";

/** Up to where the axis reaches for the tilts of small variations, in units of c. */
const HIGHEST = 1.5;

export interface HistoriesHearing {
  readonly seek: (time: number) => void;
  readonly chosen: (pair: HistoryPair) => void;
}

export class Histories {
  readonly root: HTMLElement;
  readonly #above: TimeChart;
  readonly #below: TimeChart;
  #run: RunShown | null = null;
  #wanted: HistoryPair | null = null;
  #cloud: Variations | null = null;
  #second: SecondRun | null = null;

  constructor({ seek, chosen }: HistoriesHearing) {
    this.#above = new TimeChart("Upper history", "", { seek, chosen: (name) => chosen(this.#with(name, 0)) });
    this.#below = new TimeChart("Lower history", () => axisLabel("time", "s"), {
      seek,
      chosen: (name) => chosen(this.#with(name, 1)),
    });
    this.root = element("div", { class: "times" }, this.#above.root, this.#below.root);
  }

  /** Shows the histories of a run, alone or with those of a second run. */
  show(run: RunShown, second: SecondRun | null): void {
    this.#run = run;
    this.#second = second;
    this.#draw();
  }

  /** Chooses what is shown; null: what suits the run. */
  choose(wanted: HistoryPair | null): void {
    if (wanted?.join() === this.#wanted?.join()) return;
    this.#wanted = wanted;
    this.#draw();
  }

  /** Draws the tilts of small variations behind that of the run; null: none. */
  showCloud(found: Variations | null): void {
    this.#cloud = found;
    this.#draw();
  }

  setTime(time: number): void {
    this.#above.setTime(time);
    this.#below.setTime(time);
  }

  redraw(): void {
    this.#above.redraw();
    this.#below.redraw();
  }

  #draw(): void {
    const run = this.#run;
    if (run === null) return;
    const { time } = run.answer.series;
    const end = Math.max(time.at(-1) ?? 0, this.#second?.run.answer.series.time.at(-1) ?? 0);
    const [offered, [above, below]] = [offeredHistories(run), chosenHistories(run, this.#wanted)];
    const c = run.answer.column.slenderness;
    const cloud = this.#cloud && { ...this.#cloud, factor: tiltScaling(c).factor, top: HIGHEST * c };
    for (const [chart, name] of [
      [this.#above, above],
      [this.#below, below],
    ] as const) {
      const history = historyOf(name, run);
      chart.show(history, offered, {
        cloud: name === "tilt" ? cloud : null,
        second: secondHistory(history, this.#second),
        end,
      });
    }
  }

  #with(name: HistoryName, place: 0 | 1): HistoryPair {
    const [above, below] = this.#run === null ? (["tilt", "tilt"] as const) : chosenHistories(this.#run, this.#wanted);
    return place === 0 ? [name, below] : [above, name];
  }
}
