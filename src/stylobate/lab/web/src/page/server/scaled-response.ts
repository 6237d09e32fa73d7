/** Response curves with the slenderness of the very column that they are of: they are drawn in units of it. */

import type { Described, ResponseCurves } from "./answers";
import type { Part } from "../case/description";
import { isPart, written } from "../case/description";

export interface ScaledCurves {
  readonly curves: ResponseCurves;
  readonly slenderness: number;
}

type AskCurves = (body: Part, signal: AbortSignal) => Promise<ResponseCurves>;
type AskDescribed = (description: Part) => Promise<Described>;

export class ScaledResponse {
  readonly #response: AskCurves;
  readonly #describe: AskDescribed;
  /** The column that was described last: most requests are of the same one. */
  #known = { column: "", slenderness: 0 };

  constructor(response: AskCurves, describe: AskDescribed) {
    this.#response = response;
    this.#describe = describe;
  }

  async ask(body: Part, signal: AbortSignal): Promise<ScaledCurves> {
    const [curves, slenderness] = await Promise.all([this.#response(body, signal), this.#slenderness(body["column"])]);
    return { curves, slenderness };
  }

  /** The run of the case may be answered later than its curves, or not at all: the column is asked for by itself. */
  async #slenderness(given: Part[string] | undefined): Promise<number> {
    const column = isPart(given) ? given : {};
    const wanted = written(column);
    if (wanted === this.#known.column) return this.#known.slenderness;
    const answer = await this.#describe({ column, duration: 1 });
    if (answer.column === undefined) throw new Error("the server did not describe the column");
    this.#known = { column: wanted, slenderness: answer.column.slenderness };
    return answer.column.slenderness;
  }
}
