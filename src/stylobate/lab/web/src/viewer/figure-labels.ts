/** Words below columns that stand side by side: what tells them apart. */

import { type Camera, Vector3 } from "three";
import { FONT } from "./note";
import type { Palette } from "./palette";

const BELOW = 6; // px between the edge of the base and the words
const APART = 6; // px between words, at least
const FLOOR = 30; // px at the bottom of the picture, where its scale stands

type Colours = Pick<Palette, "ink" | "background">;

interface Label {
  readonly element: HTMLElement;
  /** Where the words stand, in the frame of the base. */
  readonly at: Vector3;
}

export class FigureLabels {
  readonly #host: HTMLElement;
  #labels: readonly Label[] = [];

  constructor(host: HTMLElement) {
    this.#host = host;
  }

  /** Show these words at these places of the base; none where one column stands alone. */
  show(texts: readonly string[], places: readonly Vector3[], colour: Colours): void {
    for (const { element } of this.#labels) element.remove();
    this.#labels = texts.map((text, i) => ({ element: labelElement(text, colour), at: places[i]! }));
    this.#host.append(...this.#labels.map((one) => one.element));
  }

  /** Move the words to where the camera shows their places, which have `gone` with what it follows. */
  follow(camera: Camera, gone: Vector3, { width, height }: { readonly width: number; readonly height: number }): void {
    const places = this.#labels.map(({ at }) => at.clone().add(gone).project(camera));
    const middles = places.map(({ x }) => (0.5 + 0.5 * x) * width);
    const halves = this.#labels.map(({ element }) => element.offsetWidth / 2);
    spaced(middles, halves, width).forEach((middle, i) => {
      const { element } = this.#labels[i]!;
      const top = Math.min((0.5 - 0.5 * places[i]!.y) * height + BELOW, height - FLOOR - element.offsetHeight);
      element.style.transform = `translate(${(middle - halves[i]!).toFixed(1)}px, ${top.toFixed(1)}px)`;
    });
  }

  /** Write the same into a picture that is taken along. */
  paint(context: CanvasRenderingContext2D): void {
    context.save();
    context.font = FONT;
    context.textAlign = "center";
    context.textBaseline = "top";
    const frame = this.#host.getBoundingClientRect();
    for (const { element } of this.#labels) {
      const { left, top, width, height } = element.getBoundingClientRect();
      context.fillStyle = element.style.backgroundColor;
      context.fillRect(left - frame.left, top - frame.top, width, height);
      context.fillStyle = element.style.color;
      context.fillText(element.textContent, left - frame.left + width / 2, top - frame.top);
    }
    context.restore();
  }
}

/** Return the middles of words of these half widths, moved apart where they would overlap, inside the picture. */
export function spaced(middles: readonly number[], halves: readonly number[], width: number): number[] {
  const inside = (middle: number, i: number): number => Math.min(Math.max(middle, halves[i]!), width - halves[i]!);
  const [a, b] = middles;
  if (a === undefined || b === undefined) return middles.map(inside);
  const lacking = halves[0]! + halves[1]! + APART - Math.abs(b - a);
  const side = b < a ? -1 : 1;
  if (lacking <= 0) return middles.map(inside);
  return [a - (side * lacking) / 2, b + (side * lacking) / 2].map(inside);
}

function labelElement(text: string, colour: Colours): HTMLElement {
  const made = document.createElement("div");
  made.className = "figure-label";
  made.textContent = text;
  Object.assign(made.style, {
    ...{ position: "absolute", left: "0", top: "0", maxWidth: "48%", font: FONT, color: colour.ink },
    ...{ textAlign: "center", pointerEvents: "none", padding: "0 5px", borderRadius: "8px" },
    backgroundColor: colour.background,
    opacity: "0.9",
  });
  return made;
}
