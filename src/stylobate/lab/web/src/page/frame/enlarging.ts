/** A panel that fills the window while it is enlarged. */

import { button } from "./dom";

/** Returns the button that enlarges a panel and brings it back; Escape restores it too. */
export function enlarging(panel: () => HTMLElement, name: string): HTMLButtonElement {
  const made = button("⤢", { class: "icon enlarge", "aria-pressed": "false", "aria-label": `Enlarge ${name}` }, () =>
    set(!panel().classList.contains("large")),
  );
  made.title = `Enlarge ${name}; Escape restores it`;
  const set = (large: boolean): void => {
    panel().classList.toggle("large", large);
    made.setAttribute("aria-pressed", String(large));
  };
  document.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && panel().classList.contains("large")) set(false);
  });
  return made;
}
