/** The run of a second column beside the first: asked for whenever the case or what differs changes. */

import type { About } from "../case/about";
import { comparedCase, type Comparison, labelsOf, obstacle } from "../case/comparison";
import { type Description, written } from "../case/description";
import { standing } from "../case/starting";
import { sentence } from "../frame/format";
import { inShownUnits } from "../frame/units";
import { Latest } from "../server/latest";
import type { Run as Answer } from "../server/schema";
import { run, type WantedRun } from "../server/run";
import { Refused, type Source, Unreachable } from "../server/source";
import type { View } from "../view/state";
import { ComparisonForm } from "./comparison-form";

/** A second run, and what tells the two columns apart in words. */
export interface Second {
  readonly answer: Answer;
  readonly labels: readonly [string, string];
}

export interface ComparingHearing {
  /** The reader wants another second column, or none. */
  readonly changed: (comparison: Comparison | null) => void;
  /** There is a second run to be shown; null: there is none. */
  readonly shown: (second: Second | null) => void;
  readonly lost: (error: Unreachable) => void;
}

interface Wanted extends WantedRun {
  readonly labels: readonly [string, string];
}

export class Comparing {
  readonly form: ComparisonForm;
  readonly #about: About;
  readonly #hearing: ComparingHearing;
  readonly #runs: Latest<Wanted, Answer>;
  #asked = "";

  constructor(source: Source, about: About, hearing: ComparingHearing) {
    this.#about = about;
    this.#hearing = hearing;
    this.form = new ComparisonForm(about, hearing.changed);
    this.#runs = new Latest(async (wanted, signal) => (await run(source, wanted, signal)).answer, {
      answered: (answer, { labels }) => {
        hearing.shown({ answer, labels });
        this.form.say({ answer, label: labels[1] });
      },
      failed: (error) => this.#fail(error),
    });
  }

  /** Shows the second column of a view; a `jump` to another case leaves nothing of that of the case before. */
  show({ description, start, compared }: View, jump: boolean): void {
    this.form.show(description, compared);
    const wanted = compared === null ? null : this.#wanted(description, start, compared);
    const asked = wanted === null ? "" : written([wanted.description, start, [...wanted.labels]]);
    if (asked === this.#asked) return;
    this.#asked = asked;
    if (jump || wanted === null) this.#hearing.shown(null);
    if (wanted === null || compared === null) return this.#runs.cancel();
    const problem = obstacle(description, compared);
    if (problem !== null) return this.#stop(problem);
    this.form.say("The second column is being computed…");
    this.#runs.want(wanted, { jump });
  }

  /** Forgets what was asked: it is to be asked again. */
  forget(): void {
    this.#asked = "";
  }

  #wanted(description: Description, start: View["start"], compared: Comparison): Wanted {
    const other = comparedCase(description, compared, this.#about);
    // On a branch it starts on that of its own case, whatever start the first has there.
    const from = start === null ? other : standing(other);
    return { description: from, start, remarks: [], labels: labelsOf(description, compared) };
  }

  /** Says why there is no second column; the first stays. */
  #stop(line: string): void {
    this.#runs.cancel();
    this.#hearing.shown(null);
    this.form.say(line);
  }

  #fail(error: unknown): void {
    if (error instanceof Unreachable) return this.#hearing.lost(error);
    const lines = error instanceof Refused ? error.problems : [String(error)];
    this.#hearing.shown(null);
    this.form.say(sentence(`No second column: ${inShownUnits(lines.join("; "))}`));
  }
}
