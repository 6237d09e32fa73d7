/** The page at work: what is asked of the server when the view changes, and where its answers go. */

import { Clock, Stage } from "../viewer/index";
import type { About, Preset } from "./about";
import { Address } from "./address";
import type { Answer, Described, JobReport, ResponseCurves } from "./answers";
import { describe, Refused, response, simulate, Unreachable } from "./api";
import { Histories } from "./charts/histories";
import { OrbitChart } from "./charts/orbit";
import { ResponsePanel } from "./charts/response-panel";
import { Connection } from "./connection";
import { Controls } from "./controls/controls";
import type { Description, Part } from "./description";
import { written } from "./description";
import { element } from "./dom";
import { ExportMenu } from "./exports";
import { angularFrequency, withAngularFrequency } from "./frequency";
import { Job, problemsIn } from "./job";
import { Latest } from "./latest";
import { BrokenLink, toldOf, viewFrom } from "./link";
import { paceOf } from "./pace";
import { PlanePanel } from "./plane/plane-panel";
import type { PlaneKind } from "./planes";
import { belongs, defaultPlane, keyOf, quantitiesOf } from "./planes";
import { namesIn, Problems } from "./problems";
import type { ColumnScales } from "./quantities";
import { valueOf, withValue } from "./quantities";
import { exactRequest, isSlender, planeRequest, responseRequest, sent, usualRange } from "./requests";
import type { Plane, Tab, View } from "./state";
import { Store, viewOf } from "./state";
import { Tabs } from "./tabs";
import { ThemeSwitch } from "./theme";
import { Transport } from "./transport";
import { Verdict } from "./verdict";

const PLANES = ["map", "basin"] as const;

export class Laboratory {
  readonly clock = new Clock();
  readonly stage: Stage | null;
  readonly #about: About;
  readonly #store: Store;
  readonly #address = new Address();
  readonly #problems = new Problems();
  readonly #verdict = new Verdict();
  readonly #connection: Connection;
  readonly #controls: Controls;
  readonly #transport: Transport;
  readonly #histories: Histories;
  readonly #orbit = new OrbitChart();
  readonly #response: ResponsePanel;
  readonly #planes: Readonly<Record<PlaneKind, PlanePanel>>;
  readonly #tabs: Tabs<Tab>;
  readonly #planesHost = element("div", { class: "planes" });
  readonly #stageHost = element("div", { class: "stage" });
  readonly #runs: Latest<Description, Answer>;
  readonly #curves: Latest<Part, ResponseCurves>;
  #answer: Answer | null = null;
  /** Of which case the answer is. */
  #shown = "";
  #scales: ColumnScales = { slenderness: 0.1, frequency_scale: 1 };
  #asked = { run: "", curves: "", exact: "" };
  /** Whether the view comes from the address: then the map that it had is computed again. */
  #linked = true;
  /** Whether the motion that is due is another case, to be seen from its beginning. */
  #fresh = true;

  constructor(about: About, host: HTMLElement, header: HTMLElement, theme: ThemeSwitch, connection: Connection) {
    this.#about = about;
    this.#connection = connection;
    const [view, problem] = viewOfLink(location.hash, about);
    this.#store = new Store(view);
    this.#controls = new Controls(about, view.description, this.#problems.root, {
      edited: (description) => this.#edit({ description }),
      jumped: (description) => this.#jump({ description, filled: false }),
      preset: (preset) => this.#jump(viewOfPreset(preset)),
    });
    this.#transport = new Transport(this.clock, (speed) => this.#edit({ speed }));
    this.#histories = new Histories((time) => this.clock.seek(time));
    this.#response = new ResponsePanel({
      frequency: (value) => this.#setFrequency(value),
      range: (range) => this.#edit({ range }),
      exact: (report, ended) => this.#job("exact", this.#exactRequest() ?? {}, report, ended),
    });
    this.#planes = { map: this.#planePanel("map"), basin: this.#planePanel("basin") };
    this.#tabs = new Tabs<Tab>(
      "Planes",
      [
        { name: "orbit", title: "Orbit of the tilt", panel: this.#orbit.root },
        { name: "map", title: "Overturning map", panel: this.#planes.map.root },
        { name: "basin", title: "Basin", panel: this.#planes.basin.root },
      ],
      (tab) => this.#edit({ tab, filled: tab !== "orbit" && this.#planes[tab].axes !== null }),
    );
    const menu = new ExportMenu({ description: () => sent(this.view.description), described: () => this.#described() });
    this.stage = this.#newStage(theme);
    menu.stage = this.stage;
    header.append(menu.root, theme.root);
    this.#layOut(host);
    this.#runs = new Latest((description, signal) => simulate(sent(description), signal), {
      answered: (answer, description) => this.#take(answer, written(description)),
      failed: (error) => this.#fail(error),
      busy: (busy) => this.#stageHost.classList.toggle("busy", busy),
    });
    this.#curves = new Latest(response, {
      answered: (curves) => this.#takeCurves(curves),
      failed: (error) => this.#failCurves(error),
    });
    this.#listen();
    this.#show(view);
    if (problem !== null) this.#problems.show([problem]);
  }

  get view(): View {
    return this.#store.view;
  }

  get answer(): Answer | null {
    return this.#answer;
  }

  /** The panel of a map or basin: for those who test the page. */
  plane(kind: PlaneKind): PlanePanel {
    return this.#planes[kind];
  }

  get response(): ResponsePanel {
    return this.#response;
  }

  /** Returns the case in the languages of the package, whether its run has been answered or not. */
  async #described(): Promise<Described> {
    const wanted = written(this.view.description);
    return this.#answer !== null && this.#shown === wanted ? this.#answer : describe(sent(this.view.description));
  }

  /** Asks again for all that is shown: the server has been away. */
  refresh(): void {
    this.#asked = { run: "", curves: "", exact: "" };
    this.#show(this.view);
  }

  setTheme(theme: "light" | "dark"): void {
    this.stage?.setTheme(theme);
    this.#histories.redraw();
    this.#orbit.redraw();
    this.#response.redraw();
    this.#transport.redraw();
    for (const kind of PLANES) this.#planes[kind].redraw();
  }

  #edit(changes: Partial<View>): void {
    this.#store.change(changes);
    this.#address.replace(this.view);
  }

  #jump(changes: Partial<View>): void {
    this.#fresh = true;
    this.#problems.show([]);
    this.#address.flush();
    this.#store.change(changes);
    this.#address.push(this.view);
  }

  #show(view: View): void {
    this.#controls.show(view.description, this.#scales);
    this.#tabs.show(view.tab);
    this.#planesHost.classList.toggle("mapped", view.tab !== "orbit");
    this.#askRun(view);
    this.#askCurves(view);
    this.#showPlanes(view);
    this.#showSpeed(view);
    this.#response.showFrequency(angularFrequency(view.description.motion));
  }

  #askRun(view: View): void {
    const wanted = written(view.description);
    if (wanted === this.#asked.run) return;
    this.#asked.run = wanted;
    this.#runs.want(view.description, { jump: this.#fresh });
  }

  #range(view: View): readonly [number, number] {
    return view.range ?? usualRange(this.#scales.frequency_scale, angularFrequency(view.description.motion));
  }

  #exactRequest(): Part | null {
    return exactRequest(this.view.description, this.#range(this.view));
  }

  #askCurves(view: View): void {
    const range = this.#range(view);
    this.#response.showRange(range);
    const exact = exactRequest(view.description, range);
    const exactWanted = exact === null ? "none" : written(exact);
    if (exactWanted !== this.#asked.exact) this.#response.forgetExact();
    this.#asked.exact = exactWanted;
    this.#response.allowExact(exact !== null);
    const body = responseRequest(view.description, range);
    const wanted = body === null ? `none ${range.join()}` : written(body);
    if (wanted === this.#asked.curves) return;
    this.#asked.curves = wanted;
    if (body !== null) this.#curves.want(body, { jump: this.#fresh });
    else {
      this.#curves.cancel();
      this.#response.clear("Response curves need a harmonic base motion in the horizontal.");
    }
  }

  #showSpeed(view: View): void {
    const speed = view.speed ?? (this.#answer === null ? 1 : paceOf(view.description.motion, this.#answer));
    this.clock.speed = speed;
    this.#transport.showSpeed(speed);
  }

  #take(answer: Answer, shown: string): void {
    this.#answer = answer;
    this.#shown = shown;
    this.#problems.show([]);
    this.#controls.setWrong(new Set());
    this.#stageHost.classList.remove("old");
    const scaled = answer.column.slenderness !== this.#scales.slenderness || answer.column.frequency_scale !== this.#scales.frequency_scale;
    this.#scales = answer.column;
    if (scaled) this.#rescale();
    this.clock.setRange(0, answer.drawn.time.at(-1) ?? 0);
    this.stage?.show(answer.drawn);
    this.#histories.show(answer);
    this.#orbit.show(answer.drawn);
    this.#verdict.show(answer);
    this.#transport.showEvents(answer.events);
    this.#showSpeed(this.view);
    if (this.#fresh) this.#begin();
    this.#follow();
  }

  /** What depends on the column's own tilt and frequency, once they are known. */
  #rescale(): void {
    this.#controls.show(this.view.description, this.#scales);
    this.#askCurves(this.view);
    this.#showPlanes(this.view);
  }

  #begin(): void {
    this.#fresh = false;
    this.clock.seek(0);
    this.clock.autoplay();
    if (this.#linked && this.view.filled && this.view.tab !== "orbit") this.#fill(this.view.tab);
    this.#linked = false;
  }

  #fail(error: unknown): void {
    if (error instanceof Unreachable) return this.#lose();
    const lines = error instanceof Refused ? error.problems : [String(error)];
    if (lines.some((line) => line.startsWith("motion.upload"))) void this.#restoreRecord();
    else this.#tellProblems(lines);
  }

  #tellProblems(lines: readonly string[]): void {
    this.#problems.show(lines);
    this.#controls.setWrong(namesIn(lines));
    this.#stageHost.classList.add("old");
  }

  /** The server forgets records when it ends; what was uploaded here is sent once more. */
  async #restoreRecord(): Promise<void> {
    const restored = await this.#controls.record.restore(this.view.description.motion["upload"]).catch(() => false);
    if (restored) return this.refresh();
    this.#controls.record.askAgain();
    this.#tellProblems(["This case needs a record that the server does not hold. Choose its files again."]);
  }

  #lose(): void {
    this.#asked = { run: "", curves: "", exact: "" };
    this.#connection.lose();
  }

  #takeCurves(curves: ResponseCurves): void {
    this.#response.show(curves, this.#scales.slenderness, this.#range(this.view), isSlender(this.view.description));
    this.#response.showFrequency(angularFrequency(this.view.description.motion));
  }

  #failCurves(error: unknown): void {
    if (error instanceof Unreachable) return this.#lose();
    this.#response.tell(error instanceof Error ? error.message : String(error)); // the last good curves stay
  }

  #setFrequency(frequency: number): void {
    const { description } = this.view;
    this.#edit({ description: { ...description, motion: withAngularFrequency(description.motion, frequency) } });
  }

  #planePanel(kind: PlaneKind): PlanePanel {
    return new PlanePanel(kind, {
      axes: (plane) => this.#edit({ [kind]: plane, filled: false }),
      asked: () => {
        this.#edit({ filled: true, tab: kind });
        this.#fill(kind);
      },
      cancelled: () => this.#edit({ filled: false }),
      chosen: ([nameX, x], [nameY, y]) => {
        const description = withValue(withValue(this.view.description, nameX, x), nameY, y);
        this.#jump({ description, [kind]: this.#plane(kind, this.view) });
      },
    });
  }

  #plane(kind: PlaneKind, view: View): Plane | null {
    const quantities = quantitiesOf(kind, view.description, this.#about, this.#scales);
    const given = view[kind];
    return given !== null && belongs(given, quantities) ? given : defaultPlane(kind, view.description, quantities);
  }

  #showPlanes(view: View): void {
    for (const kind of PLANES) {
      const plane = this.#plane(kind, view);
      if (plane === null) continue;
      const quantities = quantitiesOf(kind, view.description, this.#about, this.#scales);
      const [x, y] = [valueOf(view.description, plane.x.name), valueOf(view.description, plane.y.name)];
      const values = x === undefined || y === undefined ? null : ([x, y] as const);
      this.#planes[kind].show(plane, quantities, view.description, values, keyOf(view.description, plane));
    }
  }

  #fill(kind: PlaneKind): void {
    const plane = this.#plane(kind, this.view);
    if (plane === null) return;
    // The axes are kept from now on: those that suit the case would move with the motion that is chosen in them.
    if (this.view[kind] === null) this.#edit({ [kind]: plane });
    const body = planeRequest(kind, this.view.description, plane);
    this.#planes[kind].follow((report, ended) => this.#job(kind, body, report, ended));
  }

  #job(
    kind: string,
    body: Part,
    report: (report: JobReport) => void,
    ended: (last: JobReport | null, problems: readonly string[]) => void,
  ): Job {
    return new Job(kind, body, {
      report,
      ended: (last, error) => {
        if (error instanceof Unreachable) this.#lose();
        ended(last, problemsIn(last, error));
      },
    });
  }

  #newStage(theme: ThemeSwitch): Stage | null {
    try {
      return new Stage(this.#stageHost, { theme: theme.theme });
    } catch (error) {
      const reason = error instanceof Error ? error.message : String(error);
      this.#stageHost.append(element("p", { class: "no-stage" }, reason));
      return null; // the curves tell the motion all the same
    }
  }

  #layOut(host: HTMLElement): void {
    const show = element("section", { class: "show panel", "aria-label": "Motion" }, this.#stageHost, this.#transport.root, this.#verdict.root);
    const times = element("div", { class: "times" }, this.#histories.tilt.root, this.#histories.demand.root);
    this.#planesHost.append(this.#response.root, this.#tabs.root);
    host.replaceChildren(show, this.#controls.root, times, this.#planesHost);
  }

  #listen(): void {
    this.#store.onChange((view) => this.#show(view));
    this.clock.onTick(() => this.#tick());
    window.addEventListener("popstate", () => this.#goTo(location.hash));
    document.addEventListener("keydown", (event) => this.#key(event));
    setInterval(() => this.#transport.describe(), 1000);
  }

  /** Goes to where the address points: a link, or a step back. */
  #goTo(link: string): void {
    const [view, problem] = viewOfLink(link, this.#about);
    this.#fresh = true;
    this.#linked = true;
    this.#store.change(view);
    this.#problems.show(problem === null ? [] : [problem]);
  }

  #tick(): void {
    const { time, to, playing } = this.clock;
    if (!playing && to > 0 && time >= to && this.#played && this.#transport.repeats) {
      this.#played = false;
      this.clock.play();
      return;
    }
    this.#played = playing;
    this.#follow();
  }

  /** Whether the clock ran at its last tick: at the end of a run it stops by itself. */
  #played = false;

  #follow(): void {
    const { time } = this.clock;
    this.stage?.setTime(time);
    this.#histories.setTime(time);
    this.#orbit.setTime(time);
    this.#transport.show();
  }

  #key(event: KeyboardEvent): void {
    const { target } = event;
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || !(target instanceof HTMLElement)) return;
    if (document.querySelector("dialog[open]") !== null) return;
    const written = target.closest("input:not([type=range]), select, textarea, button, summary, a, [role=tab]");
    if (event.key === " " && written === null) {
      event.preventDefault();
      this.clock.toggle();
    }
    const direction = event.key === "ArrowRight" ? 1 : event.key === "ArrowLeft" ? -1 : 0;
    if (direction !== 0 && target === document.body) {
      event.preventDefault();
      this.clock.seek(this.clock.time + (direction * this.clock.to) / (event.shiftKey ? 20 : 200));
    }
  }
}

function viewOfPreset(preset: Preset): View {
  return viewOf(preset.description, preset.view ?? {});
}

/** Returns the view of a link, or that of the first preset with a line that says what is wrong with the link. */
function viewOfLink(link: string, about: About): [View, string | null] {
  const [first] = about.presets;
  if (first === undefined) throw new Error("the server has no presets");
  const usual = viewOfPreset(first);
  if (link === "" || link === "#") return [usual, null];
  try {
    return [viewFrom(link, about), null];
  } catch (error) {
    if (error instanceof BrokenLink) return [usual, toldOf(error)];
    throw error;
  }
}
