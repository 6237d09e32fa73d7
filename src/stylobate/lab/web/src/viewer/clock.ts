/** The time that is shown: it runs with the frames of the screen, at any speed, and stops at the end. */

type Listener = (time: number) => void;

const LONGEST_STEP = 0.1; // s between frames: a page that was hidden goes on where it was

export class Clock {
  speed = 1;
  #from = 0;
  #to = 0;
  #time = 0;
  #frame: number | null = null;
  #shown: number | null = null;
  readonly #listeners = new Set<Listener>();

  get time(): number {
    return this.#time;
  }

  get playing(): boolean {
    return this.#frame !== null;
  }

  get from(): number {
    return this.#from;
  }

  get to(): number {
    return this.#to;
  }

  /** Run between these times [s]; where it stands stays, if it lies between them. */
  setRange(from: number, to: number): void {
    this.#from = from;
    this.#to = Math.max(from, to);
    this.seek(this.#time);
  }

  /** Go on; from the end, begin again. */
  play(): void {
    if (this.playing) return;
    if (this.#time >= this.#to) this.#time = this.#from;
    this.#shown = null;
    this.#frame = requestAnimationFrame(this.#tick);
    this.#report();
  }

  /** Play at once, unless the reader asked for less motion. */
  autoplay(): void {
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
  }

  pause(): void {
    if (this.#frame === null) return;
    cancelAnimationFrame(this.#frame);
    this.#frame = null;
    this.#report();
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  seek(time: number): void {
    this.#time = Math.min(this.#to, Math.max(this.#from, time));
    this.#report();
  }

  /** Call `listener` at each frame and whenever the clock is set, started or stopped; return how to end that. */
  onTick(listener: Listener): () => void {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }

  readonly #tick = (now: number): void => {
    const step = this.#shown === null ? 0 : Math.min((now - this.#shown) / 1000, LONGEST_STEP);
    this.#shown = now;
    this.#time = Math.min(this.#to, this.#time + this.speed * step);
    this.#frame = this.#time < this.#to ? requestAnimationFrame(this.#tick) : null;
    this.#report();
  };

  #report(): void {
    for (const listener of this.#listeners) listener(this.#time);
  }
}
