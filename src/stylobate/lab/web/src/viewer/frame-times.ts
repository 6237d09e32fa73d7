/** How fast pictures follow each other while something moves. */

const KEPT = 120;
const PAUSE = 500; // ms without a picture: nothing moved

export class FrameTimes {
  readonly #intervals: number[] = [];
  #last = Number.NEGATIVE_INFINITY;

  /** A picture was drawn at `now` [ms]. */
  add(now: number): void {
    const interval = now - this.#last;
    this.#last = now;
    if (interval > PAUSE) return;
    this.#intervals.push(interval);
    if (this.#intervals.length > KEPT) this.#intervals.shift();
  }

  /** Median rate of the last pictures [1/s]; 0 before there are two. */
  rate(): number {
    const ordered = [...this.#intervals].sort((a, b) => a - b);
    const median = ordered[ordered.length >> 1];
    return median === undefined ? 0 : 1000 / Math.max(median, 1e-3);
  }
}
