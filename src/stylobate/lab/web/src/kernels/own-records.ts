/** Records of the user's own, read in the page. */

import type { Value } from "../page/case/description";
import { Refused } from "../page/server/source";
import type { Samples } from "./tables";

export class OwnRecords {
  readonly #known = new Map<Value | undefined, Samples>();

  samples(upload: Value | undefined): Samples {
    const found = this.#known.get(upload);
    if (found) return found;
    throw new Refused(422, [
      `motion.upload: record '${String(upload).slice(0, 12)}' is not stored (any more). Upload its files again.`,
    ]);
  }
}
