/** Work that takes some time: started, asked after, and cancelled. */

import type { Job as JobReport } from "./schema";
import type { JobRequest, Source, Started } from "./source";

/** Between two questions after a job [ms]: often enough to see a map fill in. */
const PAUSE = 200;

export interface JobHearing {
  /** Called with every report; `events` are those that came since the one before. */
  readonly report: (report: JobReport) => void;
  /** Called once at the end; with an error where the job could not be started or asked after. */
  readonly ended: (last: JobReport | null, error: unknown) => void;
}

export class Job {
  #started: Started | null = null;
  #wanted = true;
  readonly #hearing: JobHearing;

  constructor(source: Source, kind: string, request: JobRequest, hearing: JobHearing) {
    this.#hearing = hearing;
    void this.#run(source, kind, request);
  }

  /** Stops the job and hears no more of it. */
  cancel(): void {
    if (!this.#wanted) return;
    this.#wanted = false;
    this.#started?.cancel().catch(() => undefined); // nobody waits for the answer
  }

  /** Returns the file that the job has made. */
  async file(): Promise<Blob> {
    if (this.#started === null) throw new Error("the job has not started");
    return this.#started.file();
  }

  async #run(source: Source, kind: string, request: JobRequest): Promise<void> {
    try {
      const started = await source.startJob(kind, request);
      this.#started = started;
      if (this.#wanted) await this.#follow(started);
      else await started.cancel();
    } catch (error) {
      if (this.#wanted) this.#end(null, error);
    }
  }

  async #follow(started: Started): Promise<void> {
    for (let after = 0; this.#wanted; ) {
      const report = await started.report(after);
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
