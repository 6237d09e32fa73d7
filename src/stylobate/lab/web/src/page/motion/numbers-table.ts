/** The numbers of the column and of the run, as the command line prints them. */

import type { Answer } from "../server/answers";
import { element } from "../frame/dom";
import { capital } from "../frame/format";

export class NumbersTable {
  readonly root = element("div", { class: "numbers", tabindex: 0, role: "region", "aria-label": "Numbers of the run" });

  show({ summary }: Answer): void {
    const rows = summary.map(([label, text]) =>
      element("tr", {}, element("th", { scope: "row" }, capital(label)), element("td", {}, text)),
    );
    this.root.replaceChildren(element("table", {}, element("tbody", {}, ...rows)));
  }
}
