/** Maps that the page computes: the outcome of each cell, from coarse to fine, in short pieces. */

import { type Description, type Part, type Value, isPart } from "../page/case/description";
import { standing } from "../page/case/starting";
import { withValue } from "../page/case/quantities";
import type { GridResult, Job, PlaneBegun, PlaneCells } from "../page/server/schema";
import { type JobRequest, NotMine, type Started } from "../page/server/source";
import { numbersOf } from "./answer";
import { type Case, Unknown, caseOf } from "./case";
import type { Kernels } from "./kernels";

/** Steps between the cells that are computed. */
const STRIDES = [8, 4, 2, 1];
/** Cells in a piece, at least and at most; pieces grow until one takes so long [ms] that the picture would falter. */
const [LEAST, MOST, LONG] = [24, 384, 40];

interface Axis {
  readonly name: string;
  readonly values: readonly number[];
}

/** Returns the description of a run that starts on a branch, or null where there is none. */
export type OnBranch = (description: Part, branch: string) => Promise<Part | null>;

/** Starts a map; `onBranch` returns where the runs start that follow a branch. */
export async function startMap(kernels: Kernels, request: JobRequest, onBranch: OnBranch): Promise<Started> {
  const { map, ...description } = request.description;
  if (!isPart(map)) throw new NotMine("not a map");
  const axes = [axisOf(map["x"]), axisOf(map["y"])] as const;
  const cell = (i: number, j: number): Promise<Cell> => cellAt(kernels, description, axes, [i, j], request, onBranch);
  await cell(0, 0); // what no program knows is refused before the job begins
  return new Mapping(kernels, axes, cell).started();
}

interface Cell {
  readonly asked: Case;
  readonly duration: number;
}

async function cellAt(
  kernels: Kernels,
  description: Part,
  axes: readonly [Axis, Axis],
  [i, j]: readonly [number, number],
  { start }: JobRequest,
  onBranch: OnBranch,
): Promise<Cell> {
  const [x, y] = axes;
  const changed = withValue(
    withValue(description as Description, x.name, x.values[i] ?? NaN),
    y.name,
    y.values[j] ?? NaN,
  );
  const { periods, ...given } = changed;
  const begun = start === undefined ? given : await onBranch(given, start);
  const asked = await caseOf(kernels, begun ?? standing(given as Description)); // where there is no branch
  const duration = typeof periods === "number" ? periods * (asked.shaking.period ?? NaN) : changed["duration"];
  if (typeof duration !== "number" || !(duration > 0)) throw new Unknown("the runs have no length");
  return { asked, duration };
}

function axisOf(value: Value | undefined): Axis {
  if (!isPart(value)) throw new NotMine("an axis is missing");
  const { name, from, to, number } = value;
  if (typeof from !== "number" || typeof to !== "number" || typeof number !== "number" || number < 2) {
    throw new NotMine("an axis without a range");
  }
  const values = Array.from({ length: number }, (_, k) => from + (k * (to - from)) / (number - 1));
  return { name: String(name), values };
}

class Mapping {
  readonly #kernels: Kernels;
  readonly #axes: readonly [Axis, Axis];
  readonly #cell: (i: number, j: number) => Promise<Cell>;
  readonly #codes: number[][];
  readonly #events: (PlaneBegun | PlaneCells)[] = [];
  #uncertain = 0;
  #done = 0;
  #state: Job["state"] = "running";
  #problems: readonly string[] = [];

  constructor(kernels: Kernels, axes: readonly [Axis, Axis], cell: (i: number, j: number) => Promise<Cell>) {
    this.#kernels = kernels;
    this.#axes = axes;
    this.#cell = cell;
    this.#codes = axes[0].values.map(() => axes[1].values.map(() => -1));
    const names = kernels.described.outcomes.map(({ label }, code): [number, string] => [code, label]);
    const [x, y] = axes.map(({ name, values }) => ({ name, values, ...kernels.described.axes[name] }));
    if (x && y) this.#events.push({ axes: { x, y }, names });
  }

  started(): Started {
    void this.#run().then(
      () => (this.#state = this.#state === "running" ? "done" : this.#state),
      (error: unknown) => {
        this.#state = "failed";
        this.#problems = [error instanceof Error ? error.message : String(error)];
      },
    );
    return {
      report: (after) => Promise.resolve(this.#report(after)),
      cancel: () => {
        this.#state = "cancelled";
        return Promise.resolve();
      },
      file: () => Promise.reject(new NotMine("a map is no file")),
    };
  }

  get #total(): number {
    return this.#axes[0].values.length * this.#axes[1].values.length;
  }

  async #run(): Promise<void> {
    const pace = { size: LEAST };
    for (const [stride, places] of pieces(this.#axes[0].values.length, this.#axes[1].values.length, pace)) {
      if (this.#state !== "running") return;
      const begun = performance.now();
      await this.#compute(stride, places);
      if (performance.now() - begun < LONG) pace.size = Math.min(2 * pace.size, MOST);
      await new Promise((resolve) => setTimeout(resolve)); // the page goes on meanwhile
    }
  }

  async #compute(stride: number, places: readonly (readonly [number, number])[]): Promise<void> {
    const { rtol, most_steps, common } = this.#kernels.described;
    const cells = await Promise.all(places.map(([i, j]) => this.#cell(i, j)));
    const name = cells[0]?.asked.program ?? "";
    const program = await this.#kernels.program(name);
    const accuracy = { rtol, max_steps: most_steps, traces: 0, rest_share: 1, passage_share: 1 };
    const runs = cells.map(({ asked, duration }) => numbersOf(program, { ...asked.numbers, duration, ...accuracy }));
    const found: [number, number, number][] = [];
    program.batch(runs).forEach((verdict, k) => {
      const [i, j] = places[k] ?? [0, 0];
      const code = verdict[common.columns.verdict["outcome"] ?? 0] ?? -1;
      this.#uncertain += verdict[common.columns.verdict["uncertain"] ?? 1] ?? 0;
      (this.#codes[i] ?? [])[j] = code;
      found.push([i, j, code]);
    });
    this.#done += places.length;
    this.#events.push({ stride, cells: found });
  }

  #report(after: number): Job {
    return {
      ...{ id: "", kind: "map", state: this.#state, done: this.#done, total: this.#total, note: "" },
      events: this.#events.slice(after),
      next: this.#events.length,
      problems: this.#problems,
      result: this.#state === "done" ? this.#result() : null,
    };
  }

  #result(): GridResult {
    const counts = new Map<number, number>();
    for (const code of this.#codes.flat()) counts.set(code, (counts.get(code) ?? 0) + 1);
    return {
      runs: this.#total,
      uncertain: this.#uncertain,
      codes: this.#codes,
      classes: this.#kernels.described.outcomes.map(({ label }, code) => ({
        ...{ code, name: label, share: (counts.get(code) ?? 0) / this.#total, low: null, high: null },
      })),
    };
  }
}

/** Yields each stride with some of the cells that it adds, as many as the pace says. */
function* pieces(
  width: number,
  height: number,
  pace: { readonly size: number },
): Generator<readonly [number, readonly (readonly [number, number])[]]> {
  const seen = new Set<number>();
  for (const stride of STRIDES) {
    let piece: [number, number][] = [];
    for (let i = 0; i < width; i += stride) {
      for (let j = 0; j < height; j += stride) {
        if (seen.has(i * height + j)) continue;
        seen.add(i * height + j);
        piece.push([i, j]);
        if (piece.length < pace.size) continue;
        yield [stride, piece];
        piece = [];
      }
    }
    if (piece.length > 0) yield [stride, piece];
  }
}
