/** One run of a case, from the start that is set or from that on a branch of steady rolling. */

import type { Description } from "../case/description";
import type { Branch } from "../case/starting";
import { offBranch, startedFrom } from "../case/starting";
import type { Run as Answer } from "./schema";
import { sent } from "./requests";
import type { Source } from "./source";

export interface WantedRun {
  readonly description: Description;
  /** The branch on which it starts; null: as the description sets it. */
  readonly start: Branch | null;
  /** Remarks of the server on a start that was computed before and is kept. */
  readonly remarks: readonly string[];
}

/** A run with the case that it is of, and the remarks on its start. */
export interface Run {
  readonly answer: Answer;
  readonly description: Description;
  readonly remarks: readonly string[];
}

export async function run(source: Source, wanted: WantedRun, signal: AbortSignal): Promise<Run> {
  const { description, remarks } = await started(source, wanted, signal);
  const answer = await source.simulate(sent(description), signal);
  return { answer: remarkedOn(answer, remarks), description, remarks };
}

async function started(
  source: Source,
  { description, start, remarks }: WantedRun,
  signal: AbortSignal,
): Promise<Omit<Run, "answer">> {
  if (start === null) return { description, remarks };
  const { warnings, ...from } = await source.steadyStart({ ...sent(startedFrom(description)), branch: start }, signal);
  return { description: { ...description, ...offBranch(from) }, remarks: warnings };
}

/** Returns the answer with remarks on its start before its own warnings. */
function remarkedOn(answer: Answer, remarks: readonly string[]): Answer {
  return { ...answer, warnings: [...remarks, ...answer.warnings] };
}
