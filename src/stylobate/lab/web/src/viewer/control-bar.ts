/** Play, pause, scrub, speed and the time, for a picture that stands alone. */

import type { Clock } from "./clock";
import type { DrawnMotion } from "./drawn-motion";
import { type Place, placeOf } from "./moment";

/** Return the time and that of the end with as many digits as a step on the screen is worth: 3.20 of 60.00 s. */
function timeInWords(time: number, end: number): string {
  const digits = end >= 1000 ? 0 : end >= 100 ? 1 : 2;
  return `${time.toFixed(digits)} of ${end.toFixed(digits)} s`;
}

/** Return the magnitude of the tilt over the slenderness. */
function tiltAt({ tilt, column }: DrawnMotion, { index, part }: Place): string {
  const [a, b] = [tilt[index]!, tilt[Math.min(index + 1, tilt.length - 1)]!];
  return (Math.hypot(a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])) / column.slenderness).toFixed(3);
}

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4, 8];
const STEPS = 1000; // of the scrubber
const SKIP = 0.01; // of the duration, an arrow key

export class ControlBar {
  readonly element = document.createElement("div");
  readonly #button = document.createElement("button");
  readonly #scrubber = document.createElement("input");
  readonly #output = document.createElement("output");
  readonly #end: () => void;

  constructor(
    readonly clock: Clock,
    readonly motion: DrawnMotion,
  ) {
    this.element.className = "stylobate-bar";
    this.#button.type = "button";
    this.#button.addEventListener("click", () => clock.toggle());
    Object.assign(this.#scrubber, { type: "range", min: "0", max: String(STEPS), step: "1" });
    this.#scrubber.setAttribute("aria-label", "Time");
    this.#scrubber.addEventListener("input", () => {
      clock.pause();
      clock.seek(clock.from + (Number(this.#scrubber.value) / STEPS) * (clock.to - clock.from));
    });
    this.element.append(this.#button, this.#scrubber, this.#output, this.#speedLabel());
    this.#end = clock.onTick(() => this.#show());
    this.#show();
  }

  /** Space plays and pauses, arrows go on and back, but in a control that has another use for them. */
  key(event: KeyboardEvent): void {
    const used = event.key === " " ? "button, select" : "input, select";
    if (event.target instanceof Element && event.target.closest(used) !== null) return;
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const { clock } = this;
    const skip = SKIP * (clock.to - clock.from);
    const actions: Record<string, () => void> = {
      " ": () => clock.toggle(),
      ArrowLeft: () => clock.seek(clock.time - skip),
      ArrowRight: () => clock.seek(clock.time + skip),
    };
    const action = actions[event.key];
    if (action === undefined) return;
    action();
    event.preventDefault();
  }

  dispose(): void {
    this.#end();
    this.element.remove();
  }

  #speedLabel(): HTMLElement {
    const label = document.createElement("label");
    const select = document.createElement("select");
    for (const speed of SPEEDS) {
      const option = document.createElement("option");
      Object.assign(option, { value: String(speed), textContent: `${speed} ×`, selected: speed === this.clock.speed });
      select.append(option);
    }
    select.addEventListener("change", () => {
      this.clock.speed = Number(select.value);
    });
    label.append("Speed", select);
    return label;
  }

  #show(): void {
    const { clock, motion } = this;
    const label = clock.playing ? "Pause" : "Play";
    if (this.#button.textContent !== label) this.#button.textContent = label;
    const length = clock.to - clock.from;
    this.#scrubber.value = String(length > 0 ? Math.round(((clock.time - clock.from) / length) * STEPS) : 0);
    const words = `${timeInWords(clock.time, clock.to)} · tilt ${tiltAt(motion, placeOf(motion.time, clock.time))} c`;
    this.#scrubber.setAttribute("aria-valuetext", words);
    this.#output.textContent = words;
  }
}
