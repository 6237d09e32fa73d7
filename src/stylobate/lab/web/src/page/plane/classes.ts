/** The classes of a plane: what its codes mean, how they look, and the legend that shows both. */

import { element } from "../frame/dom";
import { formatted } from "../frame/format";
import type { CellClass } from "../server/schema";
import { type Cells, UNKNOWN } from "./cells";
import { type Look, looksOf, rgbOf } from "./looks";

const [WIDTH, HEIGHT] = [18, 12];

/** A small piece of a look, for legends. */
function swatch(look: Look): HTMLCanvasElement {
  const canvas = element("canvas", { class: "swatch", width: WIDTH, height: HEIGHT, "aria-hidden": "true" });
  const pen = canvas.getContext("2d");
  if (pen === null) return canvas;
  const image = pen.createImageData(WIDTH, HEIGHT);
  const [colour, ink] = [rgbOf(look.colour), rgbOf(look.ink)];
  for (let y = 0; y < HEIGHT; y += 1) {
    for (let x = 0; x < WIDTH; x += 1) {
      image.data.set([...(look.texture?.(x, y) ? ink : colour), 255], 4 * (y * WIDTH + x));
    }
  }
  pen.putImageData(image, 0, 0);
  return canvas;
}

export type Names = readonly (readonly [code: number, name: string])[];

/** The code of cells of a basin that no run was made of. */
const NOT_COMPUTED: Names = [[-1, "not computed"]];

export class Classes {
  readonly legend = element("ul", { class: "legend classes" });
  #names: Names = [];
  #looks: ReadonlyMap<number, Look> = new Map();
  /** The classes with their shares, once all is computed. */
  #final: readonly CellClass[] = [];

  get looks(): ReadonlyMap<number, Look> {
    return this.#looks;
  }

  /** Takes the names of outcomes. */
  take(names: Names, final: readonly CellClass[] = []): void {
    this.#names = names;
    this.#final = final;
    const looks = looksOf(names.map(([, name]) => name));
    this.#looks = new Map(names.flatMap(([code], i) => (looks[i] ? [[code, looks[i]] as const] : [])));
  }

  /** Takes the classes that are known at the end, such as attractors, or what a sliding column does. */
  takeFinal(classes: readonly CellClass[]): void {
    this.take([...classes.map(({ code, name }) => [code, name] as const), ...NOT_COMPUTED], classes);
  }

  nameOf(code: number): string {
    if (code === UNKNOWN) return "not computed yet";
    return this.#names.find(([one]) => one === code)?.[1] ?? "";
  }

  /** Shows which classes there are among the cells, and their share of the plane. */
  report(cells: Cells | null): void {
    const counts = cells?.counts() ?? new Map<number, number>();
    const known = [...counts].reduce((sum, [code, count]) => sum + (code === UNKNOWN ? 0 : count), 0);
    const items = this.#names.flatMap(([code, name], i) => {
      const [count, look] = [counts.get(code) ?? 0, this.#looks.get(code)];
      if (count === 0 || look === undefined) return [];
      return [element("li", {}, swatch(look), `${name} ${shareOf(this.#final[i]) ?? percent(count / known)}`)];
    });
    this.legend.replaceChildren(...items, ...this.#remark());
  }

  /** Explains the intervals of a basin, and its starts that have not settled. */
  #remark(): readonly HTMLElement[] {
    if (!this.#final.some((one) => shareOf(one) !== null)) return [];
    const open = this.#final.some((one) => one.name === UNSETTLED)
      ? " An initial condition that has not settled may lead to any attractor. The upper end of each interval counts it there."
      : "";
    return [element("li", { class: "hint" }, `In brackets: 95 % intervals in per cent.${open}`)];
  }
}

/** The class of the starts that lead to no known attractor by the end of their runs. */
const UNSETTLED = "not settled";

function percent(share: number): string {
  return `${formatted(100 * share, share < 0.01 ? 1 : 2)} %`;
}

/** Returns the share of a class with its interval, rounded outward; null if it has none. */
export function shareOf(known: CellClass | undefined): string | null {
  if (known === undefined || known.share === null || known.low === null || known.high === null) return null;
  const { share, low, high } = known;
  return `${percent(share)} (${Math.floor(1000 * low) / 10} to ${Math.ceil(1000 * high) / 10})`;
}
