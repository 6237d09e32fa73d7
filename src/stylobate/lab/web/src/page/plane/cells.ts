/** The cells of a plane that fills in from coarse to fine. */

import type { PlaneCells } from "../server/schema";

/** No code of the server's: nothing is known of the cell yet. */
export const UNKNOWN = -128;

export class Cells {
  readonly width: number;
  readonly height: number;
  readonly #codes: Int16Array;

  constructor(width: number, height: number) {
    this.width = width;
    this.height = height;
    this.#codes = new Int16Array(width * height).fill(UNKNOWN);
  }

  at(ix: number, iy: number): number {
    return this.#codes[iy * this.width + ix] ?? UNKNOWN;
  }

  /** Takes cells of a stride; each stands for the block that begins at it, until finer ones come. */
  take({ stride, cells }: PlaneCells): void {
    for (const [ix, iy, code] of cells) {
      const [endX, endY] = [Math.min(ix + stride, this.width), Math.min(iy + stride, this.height)];
      for (let y = iy; y < endY; y += 1) this.#codes.fill(code, y * this.width + ix, y * this.width + endX);
    }
  }

  /** Takes the whole plane at once, first index along x. */
  takeAll(codes: readonly (readonly number[])[]): void {
    codes.forEach((column, ix) => column.forEach((code, iy) => (this.#codes[iy * this.width + ix] = code)));
  }

  /** Returns how many cells have each code. */
  counts(): ReadonlyMap<number, number> {
    const found = new Map<number, number>();
    for (const code of this.#codes) found.set(code, (found.get(code) ?? 0) + 1);
    return found;
  }
}
