/** What is wrong with a case or its link: in the box above the controls, beside the fields, and under the stage. */

import type { Problems } from "../frame/problems";
import { wrongIn } from "../frame/problems";
import type { MotionView } from "../motion/motion-view";
import type { Controls } from "./controls";

export class CaseProblems {
  readonly #box: Problems;
  readonly #controls: Controls;
  readonly #motion: MotionView;
  /** What was wrong with the link that was followed, until the reader goes on from there. */
  #link: readonly string[] = [];

  constructor(box: Problems, controls: Controls, motion: MotionView) {
    this.#box = box;
    this.#controls = controls;
    this.#motion = motion;
    box.listen(controls.root);
  }

  /** Whether something is wrong with the link that was followed. */
  get ofLink(): boolean {
    return this.#link.length > 0;
  }

  /** Shows why there is no new motion, whether an `earlier` one is seen, and whether it can be computed `again`. */
  show(lines: readonly string[], which: { readonly earlier: boolean; readonly again?: boolean }): void {
    this.#motion.setStale(false);
    this.#box.show(lines);
    this.#controls.setWrong(wrongIn(lines));
    this.#motion.old.show(lines, which);
  }

  showLink(problem: string | null): void {
    this.#link = problem === null ? [] : [problem];
    this.#box.show(this.#link);
  }

  /** The reader goes on from the link: nothing is said of it once another case is shown. */
  forgetLink(): void {
    this.#link = [];
  }

  /** Nothing is wrong with the case itself. */
  clear(): void {
    this.#box.show(this.#link);
    this.#controls.setWrong(new Map());
    this.#motion.old.hide();
  }
}
