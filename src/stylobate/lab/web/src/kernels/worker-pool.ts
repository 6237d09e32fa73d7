/** Computes many runs in workers, so that the page goes on meanwhile. */

import type { Common, Described } from "./program";

/** What a worker needs to make a program: compiled modules, which are not compiled again. */
export interface Setup {
  readonly mathematics: WebAssembly.Module;
  readonly program: WebAssembly.Module;
  readonly described: Described;
  readonly common: Common;
}

export interface Asked {
  readonly runs: readonly Float64Array[];
  /** Polynomials of their base motions. */
  readonly pieces: Float64Array;
}

export type Found = { readonly verdicts: readonly Float64Array[] } | { readonly problem: string };

/** Starts a worker, or throws where the page may not. */
export type StartWorker = () => Worker;

/** Computes runs, with the polynomials of their base motions; returns the numbers of `verdict` of each. */
export type Compute = (runs: readonly Float64Array[], pieces: Float64Array) => Promise<readonly Float64Array[]>;

/** Returns how many workers compute `cells`: one for each core but that of the page, each with some cells. */
export function workersFor(cells: number, least: number): number {
  return Math.max(1, Math.min((navigator.hardwareConcurrency || 2) - 1, Math.ceil(cells / least)));
}

/** How long a piece may take [ms]: in a worker, where the map should fill in, and in the page, which should go on. */
const [BESIDE, WITHIN] = [500, 40];

export interface Member {
  readonly compute: Compute;
  /** How long a piece may take [ms]. */
  readonly long: number;
}

/** Workers that compute runs of one program. */
export class WorkerPool {
  readonly members: readonly Member[];
  readonly #workers: Worker[] = [];

  /** Starts workers; where one cannot start or fails, `here` computes in its place. */
  constructor(many: number, start: StartWorker, setup: Setup, here: Compute) {
    this.members = Array.from({ length: many }, () => this.#member(start, setup, here));
  }

  /** Stops all workers at once. */
  end(): void {
    for (const worker of this.#workers) worker.terminate();
  }

  #member(start: StartWorker, setup: Setup, here: Compute): Member {
    const worker = this.#started(start, setup);
    if (worker === null) return { compute: here, long: WITHIN };
    const failed = new Promise<null>((resolve) => (worker.onerror = worker.onmessageerror = () => resolve(null)));
    const compute: Compute = async (runs, pieces) => {
      const answer = new Promise<Found>((resolve) => (worker.onmessage = ({ data }) => resolve(data as Found)));
      worker.postMessage({ runs, pieces } satisfies Asked);
      const found = await Promise.race([failed, answer]);
      if (found === null) {
        member.long = WITHIN;
        return here(runs, pieces);
      }
      if ("problem" in found) throw new Error(found.problem);
      return found.verdicts;
    };
    const member = { compute, long: BESIDE };
    return member;
  }

  #started(start: StartWorker, setup: Setup): Worker | null {
    try {
      const worker = start();
      this.#workers.push(worker);
      worker.postMessage(setup);
      return worker;
    } catch {
      return null;
    }
  }
}
