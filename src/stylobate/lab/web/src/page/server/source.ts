/** What the page asks: a server answers, or the files of a page that has none. */

import type { About } from "../case/about";
import type { Part, Value } from "../case/description";
import type {
  Described,
  Job as JobReport,
  ResponseCurves,
  Run as Answer,
  Start,
  UploadedRecord,
  Variations,
} from "./schema";

/** The question is refused: a line for each thing that is wrong. */
export class Refused extends Error {
  readonly problems: readonly string[];
  readonly status: number;

  constructor(status: number, problems: readonly string[]) {
    super(problems.join(" "));
    this.status = status;
    this.problems = problems;
  }
}

/** No answer at all; `locked`: the server was started again, and asks for its new token. */
export class Unreachable extends Error {
  readonly locked: boolean;

  constructor(message: string, { locked = false } = {}) {
    super(message);
    this.locked = locked;
  }
}

/** What a job is asked for: a description, and the branch on which its runs start, if it is a map. */
export interface JobRequest {
  readonly description: Part;
  readonly start?: string;
}

/** A job that has been started. */
export interface Started {
  /** Returns its state, with the events from the number `after` on. */
  readonly report: (after: number) => Promise<JobReport>;
  readonly cancel: () => Promise<unknown>;
  /** Returns the file of a job that makes one. */
  readonly file: () => Promise<Blob>;
}

/** What is asked at a click, or chosen; the rest is asked for each case. */
export type Ask = "start" | "variations" | "map" | "basin" | "exact" | "animation";

export interface Source {
  /** Whether there can be an answer: what has none is not offered. */
  readonly offers: (ask: Ask, question: Value) => boolean;
  readonly about: () => Promise<About>;
  /** Asks whether there are answers, and nothing else. */
  readonly alive: () => Promise<void>;
  readonly simulate: (description: Part, signal: AbortSignal) => Promise<Answer>;
  readonly variations: (description: Part, signal: AbortSignal) => Promise<Variations>;
  readonly response: (description: Part, signal: AbortSignal) => Promise<ResponseCurves>;
  readonly describe: (description: Part) => Promise<Described>;
  readonly steadyStart: (body: Part, signal: AbortSignal) => Promise<Start>;
  readonly sendRecord: (upload: Part) => Promise<UploadedRecord>;
  readonly startJob: (kind: string, request: JobRequest) => Promise<Started>;
}

/** A source for some questions: it leaves one out, or raises NotMine, where the next layer is to be asked. */
export type Layer = Partial<Source>;

export class NotMine extends Error {}

/** Returns a source that asks the layers in their order, and refuses what none of them answers. */
export function layered(layers: readonly Layer[]): Source {
  /** Asks the layers one by one for `what` they may answer. */
  async function first<Found>(what: string, ask: (layer: Layer) => Promise<Found> | undefined): Promise<Found> {
    for (const layer of layers) {
      try {
        const found = await ask(layer);
        if (found !== undefined) return found;
      } catch (error) {
        if (!(error instanceof NotMine)) throw error;
      }
    }
    throw new Refused(422, [`This page has no answer for ${what}. Install stylobate and run “stylobate lab”.`]);
  }
  return {
    offers: (ask, question) => layers.some((layer) => layer.offers?.(ask, question) ?? false),
    about: () => first("its own options", (layer) => layer.about?.()),
    alive: () => Promise.resolve(),
    simulate: (description, signal) => first(NUMBERS, (layer) => layer.simulate?.(description, signal)),
    variations: (description, signal) => first(NUMBERS, (layer) => layer.variations?.(description, signal)),
    response: (description, signal) => first(NUMBERS, (layer) => layer.response?.(description, signal)),
    describe: (description) => first(NUMBERS, (layer) => layer.describe?.(description)),
    steadyStart: (body, signal) => first(NUMBERS, (layer) => layer.steadyStart?.(body, signal)),
    sendRecord: (upload) => first("files of your own", (layer) => layer.sendRecord?.(upload)),
    startJob: (kind, request) => first(JOBS[kind] ?? NUMBERS, (layer) => layer.startJob?.(kind, request)),
  };
}

const NUMBERS = "these numbers";

/** What jobs are asked for, where it is more than numbers. */
const JOBS: Readonly<Record<string, string>> = {
  ...{ map: "maps", basin: "basins", animation: "animations as a file", exact: "exact orbits of these numbers" },
};
