/** Work that takes the server some time: started, asked after, and cancelled. */

import type { Job as JobReport } from "./schema";
import { type JobRequest, cancelJob, jobReport, startJob } from "./api";

/** Between two questions after a job [ms]: often enough to see a map fill in. */
const PAUSE = 200;

export interface JobHearing {
  /** Called with every report; `events` are those that came since the one before. */
  readonly report: (report: JobReport) => void;
  /** Called once at the end; with an error where the job could not be started or asked after. */
  readonly ended: (last: JobReport | null, error: unknown) => void;
}

export class Job {
  #id: string | null = null;
  #wanted = true;
  readonly #hearing: JobHearing;

  constructor(kind: string, request: JobRequest, hearing: JobHearing) {
    this.#hearing = hearing;
    void this.#run(kind, request);
  }

  /** Stops the job and hears no more of it. */
  cancel(): void {
    if (!this.#wanted) return;
    this.#wanted = false;
    if (this.#id !== null) cancelJob(this.#id).catch(() => undefined); // nobody waits for the answer
  }

  async #run(kind: string, request: JobRequest): Promise<void> {
    try {
      const { id } = await startJob(kind, request);
      this.#id = id;
      if (!this.#wanted) {
        await cancelJob(id);
        return;
      }
      await this.#follow(id);
    } catch (error) {
      if (this.#wanted) this.#end(null, error);
    }
  }

  async #follow(id: string): Promise<void> {
    for (let after = 0; this.#wanted; ) {
      const report = await jobReport(id, after);
      if (!this.#wanted) return;
      after = report.next;
      this.#hearing.report(report);
      if (report.state !== "waiting" && report.state !== "running") return this.#end(report, null);
      await new Promise((resolve) => setTimeout(resolve, PAUSE));
    }
  }

  #end(last: JobReport | null, error: unknown): void {
    this.#wanted = false;
    this.#hearing.ended(last, error);
  }
}

/** Returns a job's problems, or those of the error that ended it. */
export function problemsIn(last: JobReport | null, error: unknown): readonly string[] {
  if (last !== null && last.problems.length > 0) return last.problems;
  if (last?.state === "cancelled") return [];
  return error instanceof Error ? error.message.split("\n") : [];
}
