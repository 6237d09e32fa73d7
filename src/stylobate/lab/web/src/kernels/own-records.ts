/** Records from the user's own files, which never leave the browser. */

import { type Part, type Value, isPart } from "../page/case/description";
import type { UploadedRecord } from "../page/server/schema";
import { Refused } from "../page/server/source";
import { repr } from "./records/python";
import type { Upload } from "./records/upload";
import type { StartWorker } from "./worker-pool";

/** Accelerations at equal steps. */
export interface Samples {
  /** x, y, z of one instant after the other [m/s²]. */
  readonly values: Float64Array;
  /** [s]. */
  readonly step: number;
}

/** What a worker is asked, and what it answers. */
export interface Read {
  readonly read: Part;
}
export type Reading = Upload | { readonly problems: readonly string[] };

/** A record that was read here, with the plain values by which Python reads its files. */
interface Held {
  readonly samples: Samples;
  readonly reading: Part;
}

const NO_WORKER = "This browser cannot read files of records here. Install stylobate and run “stylobate lab”.";

export class OwnRecords {
  readonly #held = new Map<Value | undefined, Held>();
  readonly #startWorker: StartWorker;

  constructor(startWorker: StartWorker) {
    this.#startWorker = startWorker;
  }

  /** Returns a description whose record, if it was read here, is that of its files. */
  shown(description: Part): Part {
    const motion = description["motion"];
    const held = isPart(motion) ? this.#held.get(motion["upload"]) : undefined;
    if (held === undefined || !isPart(motion)) return description;
    const { kind, upload, ...rest } = motion;
    return { ...description, motion: { ...held.reading, ...rest } };
  }

  /** Returns the samples of a record that was read here. */
  samples(upload: Value | undefined): Samples {
    const found = this.#held.get(upload);
    if (found) return found.samples;
    const short = repr(String(upload).slice(0, 12));
    throw new Refused(422, [`motion.upload: record ${short} is not stored (any more). Upload its files again.`]);
  }

  /** Reads the files of one event. */
  async add(body: Part): Promise<UploadedRecord> {
    const { received, samples, paths } = await this.#read(body);
    this.#held.set(received.upload, { samples, reading: readingOf(body, paths) });
    return received;
  }

  async #read(body: Part): Promise<Upload> {
    const worker = this.#startWorker();
    try {
      const answer = await new Promise<Reading>((resolve) => {
        worker.onmessage = ({ data }) => resolve(data as Reading);
        worker.onerror = worker.onmessageerror = () => resolve({ problems: [NO_WORKER] });
        worker.postMessage({ read: body } satisfies Read);
      });
      if ("problems" in answer) throw new Refused(422, answer.problems);
      return answer;
    } finally {
      worker.terminate();
    }
  }
}

/** Returns the plain values by which Python reads the files of an upload. */
function readingOf({ units = null, step = null }: Part, names: readonly string[]): Part {
  const given = { ...(units === null ? {} : { units }), ...(step === null ? {} : { step }) };
  return { kind: "record", path: names.length === 1 ? (names[0] ?? "") : names, ...given, one_component: true };
}
