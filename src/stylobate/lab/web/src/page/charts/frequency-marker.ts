/** The frequency of the motion that is shown, as a line across the response that is drawn along by hand or keys. */

import { element } from "../frame/dom";
import { frequencyText } from "../frame/format";
import { rounded } from "../case/ranges";

/** The part of the range that an arrow key moves the marker by, and a page key or an arrow with shift. */
const [STEP, PAGE] = [1 / 200, 1 / 20];

/** Where the range of frequencies lies in the host [px]. */
export interface Extent {
  readonly left: number;
  readonly width: number;
  readonly range: readonly [number, number];
}

export class FrequencyMarker {
  readonly root = element("div", {
    class: "marker",
    role: "slider",
    tabindex: 0,
    "aria-label": "Angular frequency of the base motion",
  });
  readonly #host: HTMLElement;
  readonly #extent: () => Extent;
  readonly #moved: (frequency: number) => void;
  #value = 1;
  /** The finger that went down beside the marker: a tap moves the marker there, a swipe scrolls the page. */
  #tapped: number | null = null;

  constructor(host: HTMLElement, extent: () => Extent, moved: (frequency: number) => void) {
    this.#host = host;
    this.#extent = extent;
    this.#moved = moved;
    this.root.append(element("span", { class: "grip", "aria-hidden": "true" }));
    host.append(this.root);
    host.addEventListener("pointerdown", (event) => this.#grasp(event));
    host.addEventListener("pointermove", (event) => {
      if (host.hasPointerCapture(event.pointerId)) this.#follow(event);
    });
    host.addEventListener("click", (event) => {
      if (this.#tapped === event.pointerId) this.#follow(event);
      this.#tapped = null;
    });
    this.root.addEventListener("keydown", (event) => this.#key(event));
  }

  show(frequency: number | null): void {
    this.root.hidden = frequency === null;
    if (frequency === null) return;
    this.#value = frequency;
    const { left, range } = this.#extent();
    const { side } = placeOf(frequency, range);
    const value = frequencyText(frequency);
    const text = side === "inside" ? value : `${value}, ${side} the range that is shown`;
    this.root.style.transform = `translateX(${(left + this.#place()).toFixed(1)}px)`;
    this.root.dataset["side"] = side;
    this.root.title = side === "inside" ? "" : `Ω = ${text}`;
    this.root.setAttribute("aria-valuemin", String(Math.min(range[0], frequency)));
    this.root.setAttribute("aria-valuemax", String(Math.max(range[1], frequency)));
    this.root.setAttribute("aria-valuenow", String(frequency));
    this.root.setAttribute("aria-valuetext", text);
  }

  #grasp(event: PointerEvent): void {
    if (event.button !== 0 || this.root.hidden) return;
    const { left, width } = this.#extent();
    const place = event.clientX - this.#host.getBoundingClientRect().left - left;
    if (place < -GRIP || place > width + GRIP) return;
    if (event.pointerType === "touch" && Math.abs(place - this.#place()) > FINGER) {
      this.#tapped = event.pointerId;
      return;
    }
    this.#host.setPointerCapture(event.pointerId);
    this.root.focus({ preventScroll: true });
    event.preventDefault();
    this.#follow(event);
  }

  /** Returns where the marker stands, from the beginning of the range [px]. */
  #place(): number {
    const { width, range } = this.#extent();
    return placeOf(this.#value, range).share * width;
  }

  #follow(event: MouseEvent): void {
    const { left, width, range } = this.#extent();
    const share = (event.clientX - this.#host.getBoundingClientRect().left - left) / width;
    this.#to(range[0] + Math.min(Math.max(share, 0), 1) * (range[1] - range[0]));
  }

  #key(event: KeyboardEvent): void {
    const { range } = this.#extent();
    const span = range[1] - range[0];
    const step = (event.shiftKey ? PAGE : STEP) * span;
    const steps: Readonly<Record<string, number>> = {
      ArrowRight: this.#value + step,
      ArrowUp: this.#value + step,
      ArrowLeft: this.#value - step,
      ArrowDown: this.#value - step,
      PageUp: this.#value + PAGE * span,
      PageDown: this.#value - PAGE * span,
      Home: range[0],
      End: range[1],
    };
    const wanted = steps[event.key];
    if (wanted === undefined) return;
    event.preventDefault();
    event.stopPropagation(); // the arrows of the page move the clock
    this.#to(Math.min(Math.max(wanted, range[0]), range[1]));
  }

  #to(frequency: number): void {
    const { width, range } = this.#extent();
    const value = rounded(frequency, (range[1] - range[0]) / Math.max(width, 100));
    this.#moved(Math.max(value, range[0]));
  }
}

/** Returns where in a range a frequency is drawn: the end that is nearer stands for one beyond it, as an arrow. */
export function placeOf(
  frequency: number,
  [low, high]: readonly [number, number],
): { readonly share: number; readonly side: "below" | "inside" | "above" } {
  if (frequency < low) return { share: 0, side: "below" };
  if (frequency > high) return { share: 1, side: "above" };
  return { share: (frequency - low) / (high - low), side: "inside" };
}

/** How far beside the range a hand may still grasp, and how far beside the marker a finger [px]. */
const [GRIP, FINGER] = [12, 24];
