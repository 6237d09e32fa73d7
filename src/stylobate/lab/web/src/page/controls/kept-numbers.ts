/** The numbers of the kinds that a part has been of: another kind that has them too begins with them. */

import type { Kind, Parameter } from "../case/about";
import type { Part, Value } from "../case/description";

export class KeptNumbers {
  readonly #values = new Map<string, Value>();

  keep(kind: Kind, part: Part): void {
    for (const parameter of kind.parameters) {
      const value = part[parameter.name];
      if (value !== undefined) this.#values.set(quantityOf(parameter), value);
    }
  }

  /** Returns the numbers that were kept of those that the kind has. */
  of(kind: Kind): Part {
    const found = kind.parameters.map((one) => [one.name, this.#values.get(quantityOf(one))] as const);
    return Object.fromEntries(found.filter((one): one is readonly [string, Value] => one[1] !== undefined));
  }

  /** What was kept belongs to another case. */
  forget(): void {
    this.#values.clear();
  }
}

/** An amplitude in m is not one in m/s². */
function quantityOf({ name, unit }: Parameter): string {
  return `${name} [${unit ?? ""}]`;
}
