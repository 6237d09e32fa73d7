/** Questions to the server, and the two ways in which they fail. */

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

/** The server refused: a line for each thing that was wrong. */
export class Refused extends Error {
  readonly problems: readonly string[];
  readonly status: number;

  constructor(status: number, problems: readonly string[]) {
    super(problems.join(" "));
    this.status = status;
    this.problems = problems;
  }
}

/** No answer at all. */
export class Unreachable extends Error {}

export const about = (): Promise<About> => call<About>("GET", "/api/about");

/** Asks whether the server answers, and nothing else. */
export async function alive(): Promise<void> {
  await asked("HEAD", "/index.html");
}

export const simulate = (description: Part, signal: AbortSignal): Promise<Answer> =>
  call<Answer>("POST", "/api/simulate", description, signal);

export const variations = (description: Part, signal: AbortSignal): Promise<Variations> =>
  call<Variations>("POST", "/api/variations", description, signal);

export const response = (description: Part, signal: AbortSignal): Promise<ResponseCurves> =>
  call<ResponseCurves>("POST", "/api/response", description, signal);

export const describe = (description: Part): Promise<Described> =>
  call<Described>("POST", "/api/describe", description);

export const steadyStart = (body: Part, signal: AbortSignal): Promise<Start> =>
  call<Start>("POST", "/api/start", body, signal);

export const sendRecord = (upload: Part): Promise<UploadedRecord> =>
  call<UploadedRecord>("POST", "/api/records", upload);

/** What a job is asked for: a description, and the branch on which its runs start, if it is a map. */
export interface JobRequest {
  readonly description: Part;
  readonly start?: string;
}

export const startJob = (kind: string, request: JobRequest): Promise<{ readonly id: string }> =>
  call<{ readonly id: string }>("POST", "/api/jobs", { kind, ...request });

export const jobReport = (id: string, after: number): Promise<JobReport> =>
  call<JobReport>("GET", `/api/jobs/${encodeURIComponent(id)}?after=${after}`);

export const cancelJob = (id: string): Promise<unknown> =>
  call<unknown>("DELETE", `/api/jobs/${encodeURIComponent(id)}`);

export async function jobFile(id: string): Promise<Blob> {
  return (await asked("GET", `/api/jobs/${encodeURIComponent(id)}/file`)).blob();
}

async function call<Answer>(method: string, path: string, body?: Value, signal?: AbortSignal): Promise<Answer> {
  const found = await asked(method, path, body, signal);
  const text = await found.text();
  return (text === "" ? null : JSON.parse(text)) as Answer;
}

/** How long to wait before asking a busy server again [ms], and how often. */
const PATIENCE = 400;
const TIMES = 25;

async function asked(method: string, path: string, body?: Value, signal?: AbortSignal): Promise<Response> {
  for (let times = 0; ; times += 1) {
    const found = await sent(method, path, body, signal);
    if (found.ok) return found;
    const busy = found.status === 429 || found.status === 503;
    if (!busy || times >= TIMES) throw new Refused(found.status, await problemsOf(found));
    await new Promise((resolve) => setTimeout(resolve, PATIENCE));
    signal?.throwIfAborted();
  }
}

async function sent(method: string, path: string, body?: Value, signal?: AbortSignal): Promise<Response> {
  const options: RequestInit = { method, cache: "no-store", credentials: "same-origin" };
  if (signal) options.signal = signal;
  if (body !== undefined) {
    options.body = JSON.stringify(body);
    options.headers = { "Content-Type": "application/json" };
  }
  try {
    return await fetch(path, options);
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new Unreachable("the server does not answer");
  }
}

async function problemsOf(found: Response): Promise<readonly string[]> {
  try {
    const refusal = (await found.json()) as { readonly problems?: readonly string[] };
    if (refusal.problems && refusal.problems.length > 0) return refusal.problems;
  } catch {
    // What answered is not this server; its status says all that is known.
  }
  return [`the server answered with status ${found.status}`];
}
