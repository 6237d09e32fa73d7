/** The motion in all its pictures, led by one clock: stage, histories, orbit, verdict. */

import {
  Clock,
  computedUntil,
  type DrawnMotion,
  isFalling,
  type Pair,
  Stage,
  type Theme,
  withFall,
} from "../../viewer/index";
import type { Description } from "../case/description";
import { angularFrequency } from "../case/frequency";
import { Histories } from "../charts/histories";
import type { HistoryPair, RunShown } from "../charts/history-kinds";
import { OrbitChart } from "../charts/orbit";
import { button, element } from "../frame/dom";
import { Elapsed } from "../frame/elapsed";
import { capital } from "../frame/format";
import { inShownUnits, shownUnit } from "../frame/units";
import type { Run as Answer, Variations } from "../server/schema";
import type { Second } from "./comparing";
import { sharesOf } from "./shares";
import { Transport } from "./transport";
import { Verdict } from "./verdict";

/** The line under the stage that says why the case that was asked for is not shown. */
class OldNote {
  readonly root = element("div", { class: "old-note", hidden: true });
  /** Hidden from readers of the screen, who hear the same lines from the controls. */
  readonly #lines = element("div", { "aria-hidden": "true" });
  readonly #again: HTMLButtonElement;

  /** `again` hears that a run that was cancelled is wanted after all. */
  constructor(again: () => void) {
    this.#again = button("Compute again", { class: "small" }, again);
    this.root.append(this.#lines, this.#again);
  }

  /** Shows the lines, whether an earlier case is seen meanwhile, and whether the case can be computed again. */
  show(lines: readonly string[], { earlier, again = false }: { earlier: boolean; again?: boolean }): void {
    const all = earlier ? [...lines, "Shown: the last case that could be computed."] : lines;
    this.#lines.replaceChildren(...all.map((line) => element("p", {}, line)));
    this.#again.hidden = !again;
    this.root.hidden = !earlier && !again;
  }

  hide(): void {
    this.root.hidden = true;
  }
}

/** The numbers of the column and of the run, as the command line prints them. */
class NumbersTable {
  readonly root = element("div", { class: "numbers", tabindex: 0, role: "region", "aria-label": "Numbers of the run" });

  show({ summary }: Answer): void {
    const rows = summary.map(([label, text]) =>
      element("tr", {}, element("th", { scope: "row" }, capital(label)), element("td", {}, inShownUnits(text))),
    );
    this.root.replaceChildren(element("table", {}, element("tbody", {}, ...rows)));
  }
}

/** The message of a run that takes long. */
const FIRST = "computing… The first run of a model and long runs take time;";

export interface MotionHearing {
  /** The run is to be followed until its outcome is decided. */
  readonly follow: () => void;
  /** Small variations of the run are wanted. */
  readonly vary: () => void;
  readonly speed: (speed: number) => void;
  readonly histories: (pair: HistoryPair) => void;
  /** The column was pulled by hand and let go from rest at this tilt [rad]. */
  readonly pulled: (tilt: Pair) => void;
  /** Whether the column rocks along x only. */
  readonly alongX: () => boolean;
  /** The reader no longer wants the run that is computed. */
  readonly cancelled: () => void;
  /** The run that was cancelled is wanted after all. */
  readonly again: () => void;
}

export class MotionView {
  readonly clock = new Clock();
  readonly #cancel: HTMLButtonElement;
  /** Null where the browser draws no 3D; the curves show the motion all the same. */
  readonly stage: Stage | null;
  readonly orbit = new OrbitChart();
  readonly root: HTMLElement;
  readonly histories: HTMLElement;
  readonly numbers = new NumbersTable();
  readonly #host = element("div", { class: "stage empty" });
  readonly #transport: Transport;
  readonly #verdict: Verdict;
  readonly #curves: Histories;
  readonly #old: OldNote;
  readonly #waiting = element("p", { class: "waiting-note", hidden: true });
  readonly #elapsed = new Elapsed((message) => (this.#waiting.textContent = message));
  readonly #fall = element("p", { class: "fall-note", hidden: true });
  #run: RunShown | null = null;
  /** What is drawn of the run and of that of a second column, with their falls. */
  #drawn: readonly DrawnMotion[] = [];
  #second: Second | null = null;
  /** Whether the clock ran at its last tick: at the end of a run it stops by itself. */
  #played = false;

  constructor(theme: Theme, hearing: MotionHearing) {
    const { speed, histories, cancelled, again, follow, vary } = hearing;
    this.#cancel = button("Cancel", { class: "cancel-run small", hidden: true }, cancelled);
    this.#host.append(this.#cancel);
    this.#old = new OldNote(again);
    this.#verdict = new Verdict(follow, vary);
    this.#transport = new Transport(this.clock, speed);
    this.#curves = new Histories({ seek: (time) => this.clock.seek(time), chosen: histories });
    this.histories = this.#curves.root;
    this.root = element("section", { class: "show panel", "aria-label": "Motion" });
    this.root.append(this.#host, this.#old.root, this.#transport.root, this.#verdict.root);
    this.stage = this.#newStage(theme);
    this.#allowPull(hearing);
    this.#host.append(this.#waiting, this.#fall);
    this.clock.onTick(() => this.#tick());
    setInterval(() => this.#transport.describe(), 1000);
  }

  /** Shows a run of a case, whose base motion may have a frequency. */
  show(answer: Answer, description: Description): void {
    this.#host.classList.remove("empty");
    this.#old.hide();
    this.#run = { answer, frequency: angularFrequency(description.motion) };
    this.showVariations(null);
    this.#draw();
    this.orbit.show(answer.drawn);
    this.#verdict.show(answer, typeof description["duration"] === "number");
    this.numbers.show(answer);
    this.#transport.showEvents(answer.events);
  }

  /** Shows the run of a second column beside the first; null: the first alone. */
  showSecond(second: Second | null): void {
    if (second === null && this.#second === null) return;
    this.#second = second;
    this.#verdict.setWhich(second?.labels[0] ?? null);
    this.#draw();
  }

  /** The run of the second column that is shown beside the first. */
  get second(): Second | null {
    return this.#second;
  }

  #draw(): void {
    if (this.#run === null) return;
    const [first, second] = [this.#run, this.#second];
    this.#drawn = [first.answer, ...(second === null ? [] : [second.answer])].map(({ drawn, column }) =>
      withFall(drawn, column.frequency_parameter),
    );
    const [drawn, other] = this.#drawn;
    this.clock.setRange(0, Math.max(...this.#drawn.map(({ time }) => time.at(-1) ?? 0)));
    this.#transport.redraw(); // its ticks stand where the clock is as long
    this.stage?.show(drawn!, shownUnit("m"), second && { motion: other!, labels: second.labels });
    this.#curves.show(first, second && { run: { ...first, answer: second.answer }, labels: second.labels });
    this.#fall.textContent = second === null ? "from here on: not computed" : "pale: after the end of its run";
    this.#follow();
  }

  /** Shows small variations of the run, a line about them, or nothing of them. */
  showVariations(found: Variations | string | null): void {
    const cloud = found === null || typeof found === "string" ? null : found;
    this.#verdict.showShares(cloud === null ? (found as string | null) : sharesOf(cloud));
    this.#curves.showCloud(cloud);
  }

  /** Whether the clock stands in a fall that was not computed. */
  get falling(): boolean {
    return this.#drawn.some((one) => isFalling(one) && this.clock.time > computedUntil(one));
  }

  /** The time at which the clock is stopped [s]; null while it runs. */
  get stoppedAt(): number | null {
    return this.clock.playing ? null : Number(this.clock.time.toPrecision(5));
  }

  stopAt(time: number): void {
    this.clock.pause();
    this.clock.seek(time);
  }

  /** Adds what stands over the picture. */
  addOver(over: HTMLElement): void {
    this.#host.append(over);
  }

  toNextEvent(): void {
    this.#transport.toNextEvent();
  }

  /** Plays from the beginning, unless the reader asked for less motion. */
  begin(): void {
    this.clock.seek(0);
    this.clock.autoplay();
  }

  offerVariations(offered: boolean): void {
    this.#verdict.offerVariations(offered);
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
    this.#cancel.hidden = !busy;
    if (busy) this.#elapsed.begin("computing…", FIRST);
    else this.#elapsed.end();
  }

  /** The line under the stage about a case that is not shown. */
  get old(): OldNote {
    return this.#old;
  }

  /** Marks what is shown as the case before, while another one is on its way. */
  setStale(stale: boolean): void {
    this.root.classList.toggle("stale", stale);
    this.histories.classList.toggle("stale", stale);
    if (!stale) this.#follow(); // a column that was pulled is back in its motion
  }

  setTheme(theme: Theme): void {
    this.stage?.setTheme(theme);
    this.#curves.redraw();
    this.orbit.redraw();
    this.#transport.redraw();
  }

  /** While the column is pulled the clock stands; it runs on if the column is not let go at another tilt. */
  #allowPull({ pulled, alongX }: MotionHearing): void {
    let played = false;
    this.stage?.allowPull({
      alongX,
      begun: () => {
        played = this.clock.playing;
        this.clock.pause();
      },
      dropped: () => {
        this.#follow();
        if (played) this.clock.play();
      },
      released: pulled,
    });
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
    const ends = this.#drawn.map(computedUntil);
    this.stage?.setTime(time);
    this.#fall.hidden = !ends.some((end) => time > end);
    this.#curves.setTime(Math.min(time, Math.max(0, ...ends)));
    this.orbit.setTime(Math.min(time, ends[0] ?? 0));
    this.#verdict.setTime(time);
    this.#transport.show();
  }
}
