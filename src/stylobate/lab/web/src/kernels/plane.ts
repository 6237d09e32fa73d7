/** Maps that the page computes: the outcome of each cell, from coarse to fine, in pieces that workers compute. */

import { type Description, type Part, type Value, isPart } from "../page/case/description";
import { standing } from "../page/case/starting";
import { withValue } from "../page/case/quantities";
import type { GridResult, Job, PlaneBegun, PlaneCells } from "../page/server/schema";
import { type JobRequest, NotMine, type Started } from "../page/server/source";
import { numbersOf, usualDuration } from "./answer";
import { type Case, caseOf, numberOf } from "./case";
import type { Kernels } from "./kernels";
import { type Program, joined } from "./program";
import type { Tabulated } from "./tables";
import { type Compute, type Member, type StartWorker, WorkerPool, workersFor } from "./worker-pool";
import { Unknown } from "./refusals";

/** Steps between the cells that are computed. */
const STRIDES = [8, 4, 2, 1];
/** Cells in a piece, at least and at most: a program takes less time for each of many; pieces grow while they are quick. */
const [LEAST, MOST] = [24, 384];

interface Axis {
  readonly name: string;
  readonly values: readonly number[];
}

/** Returns the description of a run that starts on a branch, or null where there is none. */
export type OnBranch = (description: Part, branch: string) => Promise<Part | null>;

/** Starts a map; `onBranch` returns where the runs start that follow a branch. */
export async function startMap(
  kernels: Kernels,
  request: JobRequest,
  onBranch: OnBranch,
  startWorker: StartWorker,
): Promise<Started> {
  const { map, ...description } = request.description;
  if (!isPart(map)) throw new NotMine("not a map");
  const axes = [axisOf(map["x"]), axisOf(map["y"])] as const;
  const cell = (i: number, j: number): Promise<Cell> => cellAt(kernels, description, axes, [i, j], request, onBranch);
  const { asked } = await cell(0, 0); // what no program knows is refused before the job begins
  const program = await kernels.program(asked.program);
  const many = workersFor(axes[0].values.length * axes[1].values.length, LEAST);
  const pool = new WorkerPool(many, startWorker, await kernels.setup(asked.program), here(program));
  return new Mapping(kernels, axes, cell, program, pool).started();
}

/** Returns how the page itself computes runs. */
function here(program: Program): Compute {
  return async (runs, pieces) => {
    await new Promise((resolve) => setTimeout(resolve)); // the page goes on meanwhile
    return program.batch(runs, pieces);
  };
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
  const { period, lasts } = asked.shaking;
  const usual = lasts < Infinity ? usualDuration(kernels, asked) : NaN;
  const stated = numberOf(changed["duration"], usual, "duration");
  const duration = typeof periods === "number" ? periods * (period ?? NaN) : stated;
  if (!(duration > 0)) throw new Unknown("the runs have no length");
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
  readonly #program: Program;
  readonly #pool: WorkerPool;
  readonly #codes: number[][];
  readonly #events: (PlaneBegun | PlaneCells)[] = [];
  #uncertain = 0;
  #done = 0;
  #state: Job["state"] = "running";
  #problems: readonly string[] = [];

  constructor(
    kernels: Kernels,
    axes: readonly [Axis, Axis],
    cell: (i: number, j: number) => Promise<Cell>,
    program: Program,
    pool: WorkerPool,
  ) {
    this.#kernels = kernels;
    this.#program = program;
    this.#pool = pool;
    this.#axes = axes;
    this.#cell = cell;
    this.#codes = axes[0].values.map(() => axes[1].values.map(() => -1));
    const names = kernels.described.outcomes.map(({ label }, code): [number, string] => [code, label]);
    const [x, y] = axes.map(({ name, values }) => ({ name, values, ...kernels.described.axes[name] }));
    if (x && y) this.#events.push({ axes: { x, y }, names });
  }

  started(): Started {
    void this.#run()
      .then(
        () => (this.#state = this.#state === "running" ? "done" : this.#state),
        (error: unknown) => {
          this.#state = "failed";
          this.#problems = [error instanceof Error ? error.message : String(error)];
        },
      )
      .finally(() => this.#pool.end());
    return {
      report: (after) => Promise.resolve(this.#report(after)),
      cancel: () => {
        this.#state = "cancelled";
        this.#pool.end();
        return Promise.resolve();
      },
      file: () => Promise.reject(new NotMine("a map is no file")),
    };
  }

  get #total(): number {
    return this.#axes[0].values.length * this.#axes[1].values.length;
  }

  async #run(): Promise<void> {
    const members = this.#pool.members;
    const pace = { size: LEAST };
    for (const [stride, places] of strides(this.#axes[0].values.length, this.#axes[1].values.length)) {
      let next = 0;
      const work = async (member: Member): Promise<void> => {
        while (this.#state === "running" && next < places.length) {
          const share = Math.ceil((places.length - next) / members.length);
          const piece = places.slice(next, (next += Math.min(pace.size, Math.max(share, LEAST))));
          const begun = performance.now();
          await this.#compute(stride, piece, member.compute);
          if (performance.now() - begun < member.long) pace.size = Math.min(2 * pace.size, MOST);
        }
      };
      await Promise.all(members.map(work)); // what is coarse must not be drawn over what is fine
    }
  }

  async #compute(stride: number, places: readonly Place[], compute: Compute): Promise<void> {
    const { rtol, most_steps, common } = this.#kernels.described;
    const cells = await Promise.all(places.map(([i, j]) => this.#cell(i, j)));
    const accuracy = { rtol, max_steps: most_steps, traces: 0, rest_share: 1, passage_share: 1 };
    const found: [number, number, number][] = [];
    for (const [first, tables] of batches(cells)) {
      const width = this.#program.described.piece;
      let rows = 0;
      const runs = tables.map((table, k) => {
        const { asked, duration } = cells[first + k] ?? {};
        const own = table ? { ...table.numbers, first: rows } : {};
        rows += table ? table.pieces.length / width : 0;
        return numbersOf(this.#program, { ...asked?.numbers, ...own, duration: duration ?? NaN, ...accuracy });
      });
      const pieces = joined(tables.flatMap((table) => (table ? [table.pieces] : [])));
      (await compute(runs, pieces)).forEach((verdict, k) => {
        const [i, j] = places[first + k] ?? [0, 0];
        const code = verdict[common.columns.verdict["outcome"] ?? 0] ?? -1;
        this.#uncertain += verdict[common.columns.verdict["uncertain"] ?? 1] ?? 0;
        (this.#codes[i] ?? [])[j] = code;
        found.push([i, j, code]);
      });
    }
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

type Place = readonly [number, number];

/** Numbers in the polynomials of the base motions that are computed together, at most. */
const MOST_NUMBERS = 4_000_000;

/** Returns the tables of the base motions of cells, in parts that fit in memory, each with its first cell. */
function batches(cells: readonly Cell[]): (readonly [number, (Tabulated | undefined)[]])[] {
  const found: [number, (Tabulated | undefined)[]][] = [];
  let numbers = Infinity;
  cells.forEach(({ asked, duration }, k) => {
    const table = asked.shaking.table?.(duration);
    const more = table?.pieces.length ?? 0;
    if (numbers + more > MOST_NUMBERS) {
      found.push([k, []]);
      numbers = 0;
    }
    found.at(-1)?.[1].push(table);
    numbers += more;
  });
  return found;
}

/** Yields each stride with the cells that it adds. */
function* strides(width: number, height: number): Generator<readonly [number, readonly Place[]]> {
  const seen = new Set<number>();
  for (const stride of STRIDES) {
    const places: Place[] = [];
    for (let i = 0; i < width; i += stride) {
      for (let j = 0; j < height; j += stride) {
        if (seen.has(i * height + j)) continue;
        seen.add(i * height + j);
        places.push([i, j]);
      }
    }
    yield [stride, places];
  }
}
