/** Keys of the whole page: space plays, arrows go through the time, letters do more; what has the focus comes first. */

import type { Clock } from "../../viewer/index";

/** What takes the space bar for itself, and what the arrows. */
const PRESSED = "input:not([type=range]), select, textarea, button, summary, a";
const WRITTEN = "input:not([type=range]), select, textarea";
const MOVED = "input, select, textarea, canvas, pre, [role=tab], [role=slider]";

/** The parts of a run that an arrow goes, and with shift. */
const [STEP, STRIDE] = [1 / 200, 1 / 20];

/** Lets keys move the clock, and each of `letters` do what it stands for. */
export function listenToKeys(clock: Clock, letters: Readonly<Record<string, () => void>>): void {
  document.addEventListener("keydown", (event) => {
    const { target } = event;
    const taken = event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey;
    if (taken || !(target instanceof HTMLElement) || document.querySelector("dialog[open]") !== null) return;
    if (event.key === " " && target.closest(PRESSED) === null) {
      event.preventDefault();
      clock.toggle();
    }
    if (target.closest(WRITTEN) === null) letters[event.key]?.();
    const direction = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (direction === 0 || target.closest(MOVED) !== null) return;
    event.preventDefault();
    clock.seek(clock.time + direction * clock.to * (event.shiftKey ? STRIDE : STEP));
  });
}
