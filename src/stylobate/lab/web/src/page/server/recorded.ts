/** Answers that were written down when the page was made: found by their questions, and by nothing else. */

import type { About } from "../case/about";
import { type Value, written } from "../case/description";
import type { Job, Problems } from "./schema";
import { type Layer, NotMine, Refused, type Started } from "./source";

/** What the page holds: its options, and for each question where its answer is. */
export interface Contents {
  readonly about: About;
  readonly answers: readonly {
    readonly ask: string;
    readonly question: Value;
    /** Name of the answer. */
    readonly name: string;
  }[];
}

/** Returns the answer with this name. */
export type Read = (name: string) => Promise<unknown>;

export function recorded({ about, answers }: Contents, read: Read): Layer {
  const names = new Map(answers.map(({ ask, question, name }) => [keyOf(ask, question), name]));
  async function found<Answer>(ask: string, question: Value): Promise<Answer> {
    const name = names.get(keyOf(ask, question));
    if (name === undefined) throw new NotMine();
    const answer = await read(name);
    if (isRefusal(answer)) throw new Refused(422, answer.problems);
    return answer as Answer;
  }
  return {
    offers: (ask, question) => names.has(keyOf(ask, question)),
    about: () => Promise.resolve(about),
    simulate: (description) => found("simulate", description),
    variations: (description) => found("variations", description),
    response: (description) => found("response", description),
    describe: (description) => found("describe", description),
    steadyStart: (body) => found("start", body),
    startJob: async (kind, request) => done(kind, await found<Job["result"]>(kind, { ...request })),
  };
}

function keyOf(ask: string, question: Value): string {
  return `${ask} ${written(question)}`;
}

/** A question may have been refused when it was recorded. */
function isRefusal(answer: unknown): answer is Problems {
  return typeof answer === "object" && answer !== null && "problems" in answer;
}

/** Returns a job that had ended before it was asked for. */
function done(kind: string, result: Job["result"]): Started {
  const report: Job = {
    ...{ id: "", kind: kind as Job["kind"], state: "done", done: 0, total: 0, note: "" },
    ...{ events: [], next: 0, problems: [], result },
  };
  return {
    report: () => Promise.resolve(report),
    cancel: () => Promise.resolve(),
    file: () => Promise.reject(new NotMine("the job made no file")),
  };
}
