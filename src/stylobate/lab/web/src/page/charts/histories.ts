/** Two quantities of the run over time: tilt and demand on the contact, or what the reader chooses. */

import type { Answer } from "../server/answers";
import { element } from "../frame/dom";
import type { History, HistoryName } from "./history-kinds";
import { chosenHistories, historiesOf } from "./history-kinds";
import { TimeChart } from "./time-chart";

export type HistoryPair = readonly [HistoryName, HistoryName];

export interface HistoriesHearing {
  readonly seek: (time: number) => void;
  readonly chosen: (pair: HistoryPair) => void;
}

export class Histories {
  readonly root: HTMLElement;
  readonly #above: TimeChart;
  readonly #below: TimeChart;
  #time: readonly number[] = [];
  #offered: readonly History[] = [];
  #wanted: HistoryPair | null = null;

  constructor({ seek, chosen }: HistoriesHearing) {
    this.#above = new TimeChart("Upper history", "", { seek, chosen: (name) => chosen(this.#with(name, 0)) });
    this.#below = new TimeChart("Lower history", "time [s]", { seek, chosen: (name) => chosen(this.#with(name, 1)) });
    this.root = element("div", { class: "times" }, this.#above.root, this.#below.root);
  }

  /** Shows what is told of a run; `frequency` is that of its base motion [rad/s], where it has one. */
  show(answer: Answer, frequency: number | null): void {
    this.#time = answer.series.time;
    this.#offered = historiesOf(answer, frequency);
    this.#draw();
  }

  /** Chooses what is shown; null: what suits the run. */
  choose(wanted: HistoryPair | null): void {
    if (wanted?.join() === this.#wanted?.join()) return;
    this.#wanted = wanted;
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
    if (this.#offered.length === 0) return;
    const [above, below] = chosenHistories(this.#offered, this.#wanted);
    const names = this.#offered.map(({ name }) => name);
    if (above) this.#above.show(this.#time, above, names);
    if (below) this.#below.show(this.#time, below, names);
  }

  #with(name: HistoryName, place: 0 | 1): HistoryPair {
    const [above, below] = chosenHistories(this.#offered, this.#wanted).map((one) => one?.name ?? "tilt");
    return place === 0 ? [name, below ?? "tilt"] : [above ?? "tilt", name];
  }
}
