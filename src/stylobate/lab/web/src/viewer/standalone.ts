/** The viewer for a file of its own: `stylobateViewer.mount(element, motion)`. */

import { Clock } from "./clock";
import { ControlBar } from "./control-bar";
import { type DrawnMotion, drawable } from "./drawn-motion";
import { preferredTheme } from "./palette";
import { Stage } from "./stage";

/** Style of the viewer in a file of its own: made by the script, since its page allows no style but that. */
const RULES = `
.stylobate {
  --ink: #1c232b; --soft: #4a5563; --paper: #f5f7fa; --raised: #ffffff; --line: #7b8794; --accent: #0072b2;
  display: flex; flex-direction: column; height: 100%; min-height: min(calc(100dvh - 16px), 44rem);
  color: var(--ink); background: var(--paper); color-scheme: light;
  font: 14px/1.4 system-ui, sans-serif; font-variant-numeric: tabular-nums;
}
.stylobate.dark {
  --ink: #e6ebf1; --soft: #a9b5c3; --paper: #11151b; --raised: #1b222b; --line: #748294; --accent: #56b4e9;
  color-scheme: dark;
}
.stylobate-title { margin: 0; padding: 0.7rem 0.9rem 0.4rem; font-size: 1rem; font-weight: 600; }
.stylobate-stage { flex: 1 1 0; min-height: 14rem; position: relative; }
.stylobate-stage canvas:focus-visible { outline: 2px solid var(--accent); outline-offset: -2px; }
.stylobate-bar { display: flex; flex-wrap: wrap; align-items: center; gap: 0.5rem 0.8rem; padding: 0.6rem 0.9rem 0.8rem; }
.stylobate-bar button, .stylobate-bar select {
  font: inherit; color: inherit; background: var(--raised); border: 1px solid var(--line); border-radius: 6px;
  min-height: 2.2rem; padding: 0 0.7rem; cursor: pointer;
}
.stylobate-bar button { min-width: 5rem; font-weight: 600; }
.stylobate-bar button:hover, .stylobate-bar select:hover { border-color: var(--accent); }
.stylobate-bar input { flex: 1 1 7rem; min-width: 5rem; height: 2.2rem; margin: 0; accent-color: var(--accent); }
.stylobate-bar :focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }
.stylobate-bar output { color: var(--soft); white-space: nowrap; }
.stylobate-bar label { color: var(--soft); display: flex; align-items: center; gap: 0.4rem; }
.stylobate-problem { margin: auto; max-width: 34rem; padding: 2rem; }
`;

/** Give the document these rules, once. */
function addSheet(): void {
  if (document.querySelector(".stylobate") !== null) return;
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(RULES);
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
}

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
