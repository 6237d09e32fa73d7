/** The page of the laboratory. */

import "uplot/dist/uPlot.min.css";
import "./styles.css";
import type { Stage } from "../viewer/index";
import type { About } from "./case/about";
import { sourceOf } from "./server/choice";
import { Connection } from "./server/connection";
import { type Source, Unreachable } from "./server/source";
import { button, byId } from "./frame/dom";
import { Laboratory } from "./laboratory";
import { offered } from "./case/offered";
import type { View } from "./view/state";
import { ThemeSwitch } from "./frame/theme";

/** What those who test the page, or look into it, can ask it. */
export interface Handle {
  readonly stage: Stage | null;
  readonly laboratory: Laboratory;
  readonly source: Source;
  readonly state: () => View;
}

declare global {
  interface Window {
    stylobate?: Handle;
  }
}

async function begin(): Promise<void> {
  const source = sourceOf(document);
  let laboratory: Laboratory | null = null;
  const theme = new ThemeSwitch((now) => laboratory?.setTheme(now));
  const connection = new Connection(source, () => laboratory?.refresh());
  byId("banner", HTMLElement).replaceWith(connection.root);
  const found = offered(await answered(source, connection));
  byId("version", HTMLElement).textContent = found.version;
  laboratory = new Laboratory(
    source,
    found,
    byId("laboratory", HTMLElement),
    byId("tools", HTMLElement),
    theme,
    connection,
  );
  const shown = laboratory;
  const skip = button("Skip to the motion", { class: "skip" }, () => shown.stage?.canvas.focus());
  document.body.prepend(skip);
  void shown.begun.then(workOffline);
  window.stylobate = { stage: shown.stage, laboratory: shown, source, state: () => shown.view };
}

/** Installs what lets the page work without a connection, where it is made of files for a web server. */
function workOffline(): void {
  const script = document.querySelector<HTMLMetaElement>("meta[name=offline]")?.content;
  if (script === undefined || !location.protocol.startsWith("http") || !("serviceWorker" in navigator)) return;
  // It loads all files of the page: not before the first motion is seen. Without it the page needs its connection.
  setTimeout(() => void navigator.serviceWorker.register(script).catch(() => undefined), SEEN);
}

/** After so long the first motion is seen [ms]. */
const SEEN = 1000;

/** Asks what there is, until the server answers. */
async function answered(source: Source, connection: Connection): Promise<About> {
  for (;;) {
    try {
      return await source.about();
    } catch (error) {
      if (!(error instanceof Unreachable)) throw error;
      connection.lose(error);
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }
}

begin().catch((error: unknown) => {
  const reason = error instanceof Error ? error.message : String(error);
  byId("laboratory", HTMLElement).textContent = `The page could not start: ${reason}`;
});
