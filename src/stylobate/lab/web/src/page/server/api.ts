/** The source that asks the server of this page. */

import type { Value } from "../case/description";
import { Refused, type Source, type Started, Unreachable } from "./source";

export const server: Source = {
  offers: () => true,
  about: () => call("GET", "/api/about"),
  alive: async () => {
    await asked("HEAD", "/index.html");
  },
  simulate: (description, signal) => call("POST", "/api/simulate", description, signal),
  variations: (description, signal) => call("POST", "/api/variations", description, signal),
  response: (description, signal) => call("POST", "/api/response", description, signal),
  describe: (description) => call("POST", "/api/describe", description),
  steadyStart: (body, signal) => call("POST", "/api/start", body, signal),
  sendRecord: (upload) => call("POST", "/api/records", upload),
  startJob: async (kind, request) =>
    started((await call<{ readonly id: string }>("POST", "/api/jobs", { kind, ...request })).id),
};

function started(id: string): Started {
  const path = `/api/jobs/${encodeURIComponent(id)}`;
  return {
    report: (after) => call("GET", `${path}?after=${after}`),
    cancel: () => call("DELETE", path),
    file: async () => (await asked("GET", `${path}/file`)).blob(),
  };
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
    if (found.status === 401) throw new Unreachable("the server asks for its token", { locked: true });
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
