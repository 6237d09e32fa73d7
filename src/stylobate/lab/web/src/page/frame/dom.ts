/** Elements made by name, attributes and children; text is always text. */

type Attributes = Readonly<Record<string, string | number | boolean | undefined>>;
type Child = Node | string;

export function element<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: readonly Child[]
): HTMLElementTagNameMap[Name] {
  const made = document.createElement(name);
  for (const [attribute, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    made.setAttribute(attribute, value === true ? "" : String(value));
  }
  made.append(...children);
  return made;
}

/** Returns the element of the page with this id, which the page has or is broken. */
export function byId<Kind extends HTMLElement>(id: string, kind: new () => Kind): Kind {
  const found = document.getElementById(id);
  if (!(found instanceof kind)) throw new Error(`the page lacks #${id}`);
  return found;
}

export function button(text: string, attributes: Attributes, pressed: () => void): HTMLButtonElement {
  const made = element("button", { type: "button", ...attributes }, text);
  made.addEventListener("click", pressed);
  return made;
}

/** Returns a choice among named values, of which `chosen` hears; values of one group stand under its heading. */
export function choice(
  options: readonly (readonly [value: string, text: string, group?: string | undefined])[],
  attributes: Attributes,
  chosen: (value: string) => void,
): HTMLSelectElement {
  const groups = new Map<string | undefined, HTMLOptionElement[]>();
  for (const [value, text, group] of options)
    groups.set(group, [...(groups.get(group) ?? []), element("option", { value }, text)]);
  const listed = [...groups].flatMap(([label, members]) =>
    label === undefined ? members : [element("optgroup", { label }, ...members)],
  );
  const made = element("select", attributes, ...listed);
  made.addEventListener("change", () => chosen(made.value));
  return made;
}

let lastId = 0;

/** Returns an id that no other element has: labels and descriptions refer to it. */
export function newId(stem: string): string {
  lastId += 1;
  return `${stem}-${lastId}`;
}

/** Returns the value of a colour of the theme that is shown. */
export function themeColour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Offers `content` as a file. */
export function download(content: Blob, name: string): void {
  const address = URL.createObjectURL(content);
  element("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000); // by then the browser has taken it
}

/** Calls `seen` with the size of `host` now and whenever it changes. */
export function onResize(host: HTMLElement, seen: (width: number, height: number) => void): void {
  new ResizeObserver(() => {
    const { width, height } = host.getBoundingClientRect();
    if (width > 0 && height > 0) seen(width, height);
  }).observe(host);
}
