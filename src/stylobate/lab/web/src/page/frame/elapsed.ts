/** Reports how long something takes, once it takes long: rarely enough to be read out. */

const SECOND = 1000;
const STEP = 5; // s
const LONG = 10; // s

export class Elapsed {
  readonly #report: (message: string) => void;
  #text = "";
  #later = "";
  #begun = 0;
  #timer: number | null = null;

  constructor(report: (message: string) => void) {
    this.#report = report;
  }

  /** Reports `text`, after ten seconds `later`, now and with the time since the first one of the row. */
  begin(text: string, later = text): void {
    if (this.#timer !== null && text === this.#text) return;
    this.#text = text;
    this.#later = later;
    if (this.#timer === null) {
      this.#begun = performance.now();
      this.#timer = window.setInterval(() => this.#tick(), STEP * SECOND);
    }
    this.#tick();
  }

  end(): void {
    if (this.#timer !== null) window.clearInterval(this.#timer);
    this.#timer = null;
  }

  #tick(): void {
    const seconds = Math.round((performance.now() - this.#begun) / SECOND);
    this.#report(seconds < STEP ? this.#text : `${seconds < LONG ? this.#text : this.#later} ${seconds} s`);
  }
}
