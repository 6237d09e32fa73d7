/** The motion in all its pictures, led by one clock: stage, histories, orbit, verdict. */

import { Clock, Stage, type Theme } from "../../viewer/index";
import type { Answer } from "../server/answers";
import type { HistoryPair } from "../charts/history-kinds";
import { Histories } from "../charts/histories";
import { OrbitChart } from "../charts/orbit";
import { element } from "../frame/dom";
import { Elapsed } from "../frame/elapsed";
import { NumbersTable } from "./numbers-table";
import { Transport } from "./transport";
import { Verdict } from "./verdict";

/** What is told of a run that takes long. */
const FIRST = "computing… a model's first run on a machine takes long;";

export interface MotionHearing {
  readonly speed: (speed: number) => void;
  readonly histories: (pair: HistoryPair) => void;
}

export class MotionView {
  readonly clock = new Clock();
  /** Null where the browser draws no 3D; the curves tell the motion all the same. */
  readonly stage: Stage | null;
  readonly orbit = new OrbitChart();
  readonly root: HTMLElement;
  readonly histories: HTMLElement;
  readonly numbers = new NumbersTable();
  readonly #host = element("div", { class: "stage empty" });
  readonly #transport: Transport;
  readonly #verdict = new Verdict();
  readonly #curves: Histories;
  readonly #waiting = element("p", { class: "waiting-note", hidden: true });
  readonly #elapsed = new Elapsed((told) => (this.#waiting.textContent = told));
  /** Whether the clock ran at its last tick: at the end of a run it stops by itself. */
  #played = false;

  constructor(theme: Theme, { speed, histories }: MotionHearing) {
    this.#transport = new Transport(this.clock, speed);
    this.#curves = new Histories({ seek: (time) => this.clock.seek(time), chosen: histories });
    this.histories = this.#curves.root;
    this.root = element("section", { class: "show panel", "aria-label": "Motion" });
    this.root.append(this.#host, this.#transport.root, this.#verdict.root);
    this.stage = this.#newStage(theme);
    this.#host.append(this.#waiting);
    this.clock.onTick(() => this.#tick());
    setInterval(() => this.#transport.describe(), 1000);
  }

  /** Shows a run; `frequency` is that of its base motion [rad/s], where it has one. */
  show(answer: Answer, frequency: number | null): void {
    this.#host.classList.remove("old", "empty");
    this.clock.setRange(0, answer.drawn.time.at(-1) ?? 0);
    this.stage?.show(answer.drawn);
    this.#curves.show(answer, frequency);
    this.orbit.show(answer.drawn);
    this.#verdict.show(answer);
    this.numbers.show(answer);
    this.#transport.showEvents(answer.events);
    this.#follow();
  }

  /** Plays from the beginning, unless the reader asked for less motion. */
  begin(): void {
    this.clock.seek(0);
    this.clock.autoplay();
  }

  /** Chooses what is drawn over time; null: what suits the run. */
  setHistories(pair: HistoryPair | null): void {
    this.#curves.choose(pair);
  }

  setSpeed(speed: number): void {
    this.clock.speed = speed;
    this.#transport.showSpeed(speed);
  }

  setBusy(busy: boolean): void {
    this.#host.classList.toggle("busy", busy);
    this.#waiting.hidden = !busy;
    if (busy) this.#elapsed.begin("computing…", FIRST);
    else this.#elapsed.end();
  }

  /** Tells that what is shown is not the case that was asked for. */
  setOld(old: boolean): void {
    this.#host.classList.toggle("old", old);
  }

  /** Tells that what is shown is the case before, while another one is on its way. */
  setStale(stale: boolean): void {
    this.root.classList.toggle("stale", stale);
    this.histories.classList.toggle("stale", stale);
  }

  setTheme(theme: Theme): void {
    this.stage?.setTheme(theme);
    this.#curves.redraw();
    this.orbit.redraw();
    this.#transport.redraw();
  }

  #newStage(theme: Theme): Stage | null {
    try {
      return new Stage(this.#host, { theme });
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      this.#host.append(element("p", { class: "no-stage" }, reason));
      return null;
    }
  }

  #tick(): void {
    const { time, to, playing } = this.clock;
    if (!playing && to > 0 && time >= to && this.#played && this.#transport.repeats) {
      this.#played = false;
      this.clock.play();
      return;
    }
    this.#played = playing;
    this.#follow();
  }

  #follow(): void {
    const { time } = this.clock;
    this.stage?.setTime(time);
    this.#curves.setTime(time);
    this.orbit.setTime(time);
    this.#transport.show();
  }
}
