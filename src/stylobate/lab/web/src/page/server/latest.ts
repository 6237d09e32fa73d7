/**
 * One request of a kind at a time, and after it the newest that was wanted meanwhile: a slider that is dragged asks
 * a hundred times a second, and what counts is its last value and, on the way, as many pictures as there is time for.
 */

type Ask<Wanted, Answer> = (wanted: Wanted, signal: AbortSignal) => Promise<Answer>;

export interface Hearing<Wanted, Answer> {
  readonly answered: (answer: Answer, wanted: Wanted) => void;
  readonly failed: (error: unknown, wanted: Wanted) => void;
  /** Called when the first request of a row sets out, and when none is left. */
  readonly busy?: (busy: boolean) => void;
}

/**
 * How long a request whose answer nobody wants may go on [ms]: most are answered by then, and to break one off costs
 * the server more than to answer it.
 */
const PATIENCE = 1500;

interface Running {
  readonly broken: AbortController;
  readonly begun: number;
  stale: boolean;
}

export class Latest<Wanted, Answer> {
  readonly #ask: Ask<Wanted, Answer>;
  readonly #hearing: Hearing<Wanted, Answer>;
  #running: Running | null = null;
  #next: { readonly wanted: Wanted } | null = null;

  constructor(ask: Ask<Wanted, Answer>, hearing: Hearing<Wanted, Answer>) {
    this.#ask = ask;
    this.#hearing = hearing;
  }

  /** Asks, after the request that runs; a `jump` to another case wants no answer of that any more. */
  want(wanted: Wanted, { jump = false } = {}): void {
    this.#next = { wanted };
    if (jump) this.#dismiss();
    if (this.#running === null) void this.#run();
  }

  /** Forgets what was wanted. */
  cancel(): void {
    this.#next = null;
    this.#dismiss();
  }

  #dismiss(): void {
    const running = this.#running;
    if (running === null || running.stale) return;
    running.stale = true;
    setTimeout(() => running.broken.abort(), Math.max(running.begun + PATIENCE - performance.now(), 0));
  }

  async #run(): Promise<void> {
    this.#hearing.busy?.(true);
    while (this.#next !== null) {
      const { wanted } = this.#next;
      this.#next = null;
      const running: Running = { broken: new AbortController(), begun: performance.now(), stale: false };
      this.#running = running;
      try {
        const answer = await this.#ask(wanted, running.broken.signal);
        if (!running.stale) this.#hearing.answered(answer, wanted);
      } catch (error) {
        if (!running.stale) this.#hearing.failed(error, wanted);
      }
    }
    this.#running = null;
    this.#hearing.busy?.(false);
  }
}
