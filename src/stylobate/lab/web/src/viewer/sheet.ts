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
export function addSheet(): void {
  if (document.querySelector(".stylobate") !== null) return;
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(RULES);
  document.adoptedStyleSheets = [...document.adoptedStyleSheets, sheet];
}
