/** The viewer for a file of its own: `stylobateViewer.mount(element, motion)`. */

import { Clock } from "./clock";
import { ControlBar } from "./control-bar";
import { drawable, type DrawnMotion } from "./drawn-motion";
import { preferredTheme } from "./palette";
import { addSheet } from "./sheet";
import { Stage } from "./stage";

export interface Mounted {
  readonly clock: Clock;
  readonly stage: Stage;
  dispose(): void;
}

/** Show a motion in `host`, or why it cannot be shown; return what moves it. */
export function mount(host: HTMLElement, motion: DrawnMotion): Mounted | null {
  addSheet();
  const root = element("div", "stylobate");
  host.replaceChildren(root);
  const dress = (): void => void root.classList.toggle("dark", preferredTheme() === "dark");
  dress();
  try {
    return fill(root, drawable(motion), dress);
  } catch (problem) {
    const text = element("p", "stylobate-problem", problem instanceof Error ? problem.message : String(problem));
    text.setAttribute("role", "alert");
    root.replaceChildren(text);
    return null;
  }
}

function fill(root: HTMLElement, motion: DrawnMotion, dress: () => void): Mounted {
  const place = element("div", "stylobate-stage");
  root.append(element("h1", "stylobate-title", motion.title), place);
  const stage = new Stage(place);
  stage.show(motion);

  const clock = new Clock();
  clock.setRange(motion.time[0]!, motion.time.at(-1)!);
  const bar = new ControlBar(clock, motion);
  root.append(bar.element);
  const key = (event: KeyboardEvent): void => {
    const { target } = event;
    if (target === document.body || (target instanceof Node && root.contains(target))) bar.key(event);
  };
  document.addEventListener("keydown", key);

  const end = clock.onTick((time) => stage.setTime(time));
  const scheme = matchMedia("(prefers-color-scheme: dark)");
  const change = (): void => {
    dress();
    stage.setTheme(preferredTheme());
  };
  scheme.addEventListener("change", change);
  clock.autoplay();
  return {
    clock,
    stage,
    dispose: () => {
      clock.pause();
      end();
      scheme.removeEventListener("change", change);
      document.removeEventListener("keydown", key);
      bar.dispose();
      stage.dispose();
      root.remove();
    },
  };
}

function element(tag: string, name: string, text = ""): HTMLElement {
  const made = document.createElement(tag);
  made.className = name;
  made.textContent = text;
  return made;
}
