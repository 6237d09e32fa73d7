/** The overturning map and the basin of the case that is shown, filled in on request. */

import type { About } from "../case/about";
import type { Description } from "../case/description";
import { belongs, defaultPlane, keyOf, quantitiesOf } from "./planes";
import type { ColumnScales, Quantity } from "../case/quantities";
import { valueOf, withValue } from "../case/quantities";
import { isSlender, planeRequest } from "../server/requests";
import { GRIDS } from "../server/declared";
import type { JobStart } from "../charts/response-asking";
import { lengthOf, withLength } from "../case/run-length";
import { type HasBranch, branchesOf } from "../case/starting";
import type { JobRequest, Source } from "../server/source";
import type { Plane, PlaneKind, View } from "../view/state";
import { PLANE_KINDS, isPlaneKind, ofPlanes } from "../view/state";
import { PlanePanel } from "./plane-panel";

/** Cells along an axis of a plane that is filled unasked. */
const FEW = 25;

export interface PlanesHearing {
  readonly edited: (changes: Partial<View>) => void;
  readonly jumped: (changes: Partial<View>) => void;
  readonly start: JobStart;
}

export class PlanesAsking {
  readonly panels: Readonly<Record<PlaneKind, PlanePanel>>;
  readonly #about: About;
  readonly #offers: Source["offers"];
  readonly #hasBranch: HasBranch;
  readonly #hearing: PlanesHearing;
  #view: View;
  #scales: ColumnScales;

  constructor(source: Pick<Source, "offers">, about: About, view: View, scales: ColumnScales, hearing: PlanesHearing) {
    this.#offers = source.offers;
    this.#hasBranch = branchesOf(source);
    this.#about = about;
    this.#view = view;
    this.#scales = scales;
    this.#hearing = hearing;
    this.panels = ofPlanes((kind) => this.#panel(kind));
  }

  show(view: View, scales: ColumnScales): void {
    this.#view = view;
    this.#scales = scales;
    const { description } = view;
    for (const kind of PLANE_KINDS) {
      const plane = this.#plane(kind);
      if (plane === null) continue;
      const quantities = quantitiesOf(kind, description, this.#about, scales);
      const [x, y] = [valueOf(description, plane.x.name), valueOf(description, plane.y.name)];
      const values = x === undefined || y === undefined ? null : ([x, y] as const);
      const length = lengthOf(kind, description, plane, scales);
      this.panels[kind].show(plane, quantities, description, values, length, keyOf(description, plane, length));
    }
  }

  /** Whether the plane of the case that is shown can be computed. */
  offers(kind: PlaneKind): boolean {
    const plane = this.#plane(kind);
    return plane !== null && this.#offers(kind, { ...this.#request(kind, plane) });
  }

  /** Computes the plane of the tab again that the view says was computed, unless it is all there. */
  refill(): void {
    const { tab, filled } = this.#view;
    if (filled && isPlaneKind(tab) && this.offers(tab) && !this.panels[tab].current) this.#fill(tab);
  }

  /** Fills a plane that is seen for the first time with few cells, where they take about a second. */
  open(kind: PlaneKind): void {
    const plane = this.#plane(kind);
    if (plane === null || this.#view[kind] !== null || !isSlender(this.#view.description)) return;
    const few = { ...plane, x: { ...plane.x, number: FEW }, y: { ...plane.y, number: FEW } };
    this.#hearing.edited({ [kind]: few, filled: true, tab: kind });
    this.#fill(kind);
  }

  redraw(): void {
    for (const kind of PLANE_KINDS) this.panels[kind].redraw();
  }

  #panel(kind: PlaneKind): PlanePanel {
    const { edited, jumped } = this.#hearing;
    return new PlanePanel(kind, this.#hasBranch, {
      axes: (plane) => edited({ [kind]: plane, filled: false }),
      asked: () => {
        edited({ filled: true, tab: kind });
        this.#fill(kind);
      },
      cancelled: () => edited({ filled: false }),
      chosen: (x, y) => {
        const plane = this.#plane(kind);
        jumped({ description: this.#at(kind, x, y), [kind]: plane, start: plane?.start ?? null });
      },
    });
  }

  /** Returns the case of a cell, followed as long as the cell's own run was: the view shows the run of the cell. */
  #at(kind: PlaneKind, [nameX, x]: readonly [string, number], [nameY, y]: readonly [string, number]): Description {
    const { description } = this.#view;
    const plane = this.#plane(kind);
    if (plane === null) return description;
    const length = lengthOf(kind, description, plane, this.#scales);
    const longest = this.#about.limits["duration"];
    const chosen = withValue(withValue(description, nameX, x), nameY, y);
    return withLength(length, chosen, typeof longest === "number" ? longest : Infinity);
  }

  #plane(kind: PlaneKind): Plane | null {
    const { description, [kind]: given } = this.#view;
    const quantities = quantitiesOf(kind, description, this.#about, this.#scales);
    const plane = given !== null && belongs(given, quantities) ? given : this.#usual(kind, quantities);
    // Another motion may have no branch to start on.
    const known = plane?.start === undefined || this.#hasBranch(description, plane.start);
    return known || plane === null ? plane : { x: plane.x, y: plane.y };
  }

  /** Returns the plane that suits the case: with it, the runs of a map follow a branch, each that of its own motion. */
  #usual(kind: PlaneKind, quantities: readonly Quantity[]): Plane | null {
    const { description, start } = this.#view;
    const plane = defaultPlane(kind, description, quantities);
    return plane === null || start === null || GRIDS[kind].starts ? plane : { ...plane, start };
  }

  #fill(kind: PlaneKind): void {
    const plane = this.#plane(kind);
    if (plane === null) return;
    // The axes are kept from now on: those that suit the case would move with the motion that is chosen in them.
    if (this.#view[kind] === null) this.#hearing.edited({ [kind]: plane });
    const request = this.#request(kind, plane);
    this.panels[kind].follow((report, ended) => this.#hearing.start(kind, request, report, ended));
  }

  #request(kind: PlaneKind, plane: Plane): JobRequest {
    const { description } = this.#view;
    const body = planeRequest(kind, description, plane, lengthOf(kind, description, plane, this.#scales));
    return { description: body, ...(plane.start === undefined ? {} : { start: plane.start }) };
  }
}
