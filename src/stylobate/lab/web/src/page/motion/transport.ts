/** Play, pause, speed and the line of time, with a tick for each event. */

import type { Clock } from "../../viewer/index";
import type { Run as Answer } from "../server/schema";
import { button, choice, element, newId, onResize, themeColour } from "../frame/dom";
import { clockTime, formatted, words } from "../frame/format";
import { joined } from "../frame/units";
import { SPEEDS } from "../view/state";

/** Steps of the line of time: finer than its pixels. */
const STEPS = 2000;

export class Transport {
  readonly root: HTMLElement;
  readonly #clock: Clock;
  readonly #play: HTMLButtonElement;
  readonly #repeat: HTMLButtonElement;
  readonly #next: HTMLButtonElement;
  readonly #speed: HTMLSelectElement;
  readonly #line = element("input", {
    type: "range",
    min: 0,
    max: STEPS,
    step: 1,
    value: 0,
    class: "slider",
    "aria-label": "Time",
  });
  readonly #ticks = element("canvas", { class: "ticks", "aria-hidden": "true" });
  readonly #time = element("output", { class: "time" });
  #events: Answer["events"] = [];
  #width = 0;
  #shown = "";

  constructor(clock: Clock, speedChosen: (speed: number) => void) {
    this.#clock = clock;
    this.#play = button("", { class: "icon", "aria-label": "Play" }, () => clock.toggle());
    this.#repeat = button(
      "↻",
      { class: "icon", "aria-label": "Repeat", "aria-pressed": "true", title: "Begin again at the end" },
      () => this.#toggleRepeat(),
    );
    this.#next = button("⇥", { class: "icon", "aria-label": "Next event", title: "Go to the next event (N)" }, () =>
      this.toNextEvent(),
    );
    const id = newId("speed");
    this.#speed = choice(
      SPEEDS.map((speed) => [String(speed), `${speed}×`]),
      { id, title: "Speed" },
      (value) => speedChosen(Number(value)),
    );
    const line = element("div", { class: "timeline" }, this.#line, this.#ticks);
    const label = element("label", { for: id, class: "visually-hidden" }, "Speed");
    this.root = element(
      "div",
      { class: "transport" },
      ...[this.#play, this.#repeat, this.#next, label, this.#speed, line, this.#time],
    );
    this.#line.addEventListener("input", () => clock.seek((Number(this.#line.value) / STEPS) * clock.to));
    onResize(line, (width) => {
      this.#width = width;
      this.#drawTicks();
    });
  }

  get repeats(): boolean {
    return this.#repeat.getAttribute("aria-pressed") === "true";
  }

  showEvents(events: Answer["events"]): void {
    this.#events = events;
    this.#next.disabled = events.length === 0;
    this.#drawTicks();
  }

  /** Stops at the next event. */
  toNextEvent(): void {
    const time = nextEvent(this.#events, this.#clock.time, this.#clock.to);
    if (time === null) return;
    this.#clock.pause();
    this.#clock.seek(time);
  }

  showSpeed(speed: number): void {
    const text = String(speed);
    if (![...this.#speed.options].some((one) => one.value === text)) {
      this.#speed.append(element("option", { value: text }, `${formatted(speed)}×`));
    }
    this.#speed.value = text;
  }

  /** Follows the clock. */
  show(): void {
    const { time, to, playing } = this.#clock;
    this.#line.value = String(to > 0 ? Math.round((time / to) * STEPS) : 0);
    this.#time.textContent = joined(clockTime(time, to), "s");
    const state = playing ? "Pause" : "Play";
    if (state === this.#shown) return;
    this.#shown = state;
    this.#play.textContent = playing ? "❚❚" : "▶";
    this.#play.setAttribute("aria-label", state);
    this.#play.title = `${state} (space)`;
  }

  /** Announces the position of the line to screen readers: not at every frame. */
  describe(): void {
    this.#line.setAttribute(
      "aria-valuetext",
      `${clockTime(this.#clock.time, this.#clock.to)} of ${joined(clockTime(this.#clock.to, this.#clock.to), "s")}`,
    );
  }

  redraw(): void {
    this.#drawTicks();
  }

  #toggleRepeat(): void {
    this.#repeat.setAttribute("aria-pressed", String(!this.repeats));
  }

  #drawTicks(): void {
    if (this.#width === 0) return;
    const ratio = window.devicePixelRatio;
    this.#ticks.width = Math.round(this.#width * ratio);
    this.#ticks.height = Math.round(TICK * ratio);
    const pen = this.#ticks.getContext("2d");
    if (pen === null || this.#clock.to === 0) return;
    pen.scale(ratio, ratio);
    const room = this.#width - THUMB; // the thumb's middle does not reach the ends of the line
    for (const { kind, time } of this.#events) {
      pen.fillStyle = themeColour(COLOURS[kind] ?? "muted");
      pen.fillRect(THUMB / 2 + (time / this.#clock.to) * room - 0.75, 0, 1.5, TICK);
    }
    const kinds = [...new Set(this.#events.map((event) => event.kind))];
    this.#ticks.title = kinds.map((kind) => `${words(kind)}: ${timesOf(this.#events, kind)}`).join("\n");
  }
}

/** How near an event counts as reached, in parts of the run. */
const REACHED = 1e-4;

/** Returns the time of the first event after a time, after the last one again that of the first. */
export function nextEvent(events: Answer["events"], time: number, end: number): number | null {
  const times = events.map((event) => event.time).sort((a, b) => a - b);
  return times.find((one) => one > time + REACHED * end) ?? times[0] ?? null;
}

const [TICK, THUMB] = [8, 16]; // px

const COLOURS: Readonly<Record<string, string>> = {
  overturned: "vermilion",
  limit: "vermilion",
  failed: "vermilion",
  rest: "green",
  uplift: "blue",
  lifted: "purple",
  lift: "purple",
  land: "purple",
};

function timesOf(events: Answer["events"], kind: string): string {
  const times = events.filter((event) => event.kind === kind).map((event) => formatted(event.time, 3));
  const [listed, more] = times.length > 6 ? [times.slice(0, 5), ` and ${times.length - 5} more`] : [times, ""];
  return `${joined(listed.join(", "), "s")}${more}`;
}
