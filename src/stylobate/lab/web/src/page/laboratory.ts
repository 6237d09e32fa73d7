/** The page at work: what is asked when the view changes, and where the answers go. */

import type { Clock, Pair, Stage, Theme } from "../viewer/index";
import type { About, Lesson } from "./case/about";
import type { Run as Answer, Variations } from "./server/schema";
import { sent } from "./server/requests";
import { Refused, type Source, Unreachable } from "./server/source";
import type { ResponsePanel } from "./charts/response-panel";
import type { Connection } from "./server/connection";
import { isPlanar } from "./case/in-one-plane";
import { CaseProblems } from "./controls/case-problems";
import { Controls } from "./controls/controls";
import { NOT_HERE } from "./controls/record-form";
import type { Comparison } from "./case/comparison";
import type { Part } from "./case/description";
import { written } from "./case/description";
import { element } from "./frame/dom";
import { Job, problemsIn } from "./server/job";
import { Help } from "./frame/help";
import { listenToKeys } from "./frame/keys";
import { Latest } from "./server/latest";
import { menuOf } from "./view/menu";
import { Comparing } from "./motion/comparing";
import { MotionView } from "./motion/motion-view";
import { paceOf } from "./motion/pace";
import { edgeOf } from "./motion/shares";
import type { PlanePanel } from "./plane/plane-panel";
import { PlanesAsking } from "./plane/planes-asking";
import { Problems } from "./frame/problems";
import type { ColumnScales } from "./case/quantities";
import { type JobStart, ResponseAsking } from "./charts/response-asking";
import type { PlaneKind, Tab, View } from "./view/state";
import { isPlaneKind, PLANE_KINDS, PLANES, Store, TABS } from "./view/state";
import { Tabs } from "./frame/tabs";
import type { ThemeSwitch } from "./frame/theme";
import type { Branch } from "./case/starting";
import { branchesOf, standing, startAlike, startOf } from "./case/starting";
import type { Run, WantedRun } from "./server/run";
import { run } from "./server/run";
import { setUnitsOf } from "./frame/units";
import { LessonCard } from "./tour/lesson-card";
import { SceneMode } from "./view/scene-mode";
import { Address, firstView, inWords, viewOfLesson, viewOfLink, viewOfPreset } from "./view/link";

/** Before the first answer: the column of the equations, and its scales. */
const ANY_COLUMN: Part = { shape: "dimensionless", slenderness: 0.1 };
const ITS_SCALES: ColumnScales = { slenderness: 0.1, frequency_scale: 1 };

export class Laboratory {
  /** The first motion is shown. */
  readonly begun: Promise<void>;
  #begun: () => void = () => undefined;
  readonly #source: Source;
  readonly #about: About;
  readonly #store: Store;
  readonly #address = new Address();
  readonly #connection: Connection;
  readonly #problems: CaseProblems;
  readonly #controls: Controls;
  readonly #motion: MotionView;
  readonly #comparing: Comparing;
  readonly #response: ResponseAsking;
  readonly #planes: PlanesAsking;
  readonly #tabs: Tabs<Tab>;
  readonly #lesson: LessonCard;
  readonly #scene: SceneMode;
  readonly #host: HTMLElement;
  readonly #planesHost = element("div", { class: "planes" });
  readonly #runs: Latest<WantedRun, Run>;
  readonly #varied: Latest<Part, Variations>;
  #scales = ITS_SCALES;
  /** Which column has the scales. */
  #scaled = written(ANY_COLUMN);
  #answer: Answer | null = null;
  /** Of which case the answer is, and which was asked for last. */
  #shown = "";
  #moved: Part = {};
  #asked = "";
  /** The last case whose start is that on a branch. */
  #started: WantedRun | null = null;
  /** Whether the view comes from the address: then the map that it had is computed again. */
  #linked = true;
  /** Whether the view comes from a preset or a link, with the start that belongs to it. */
  #given = true;
  /** Whether the case has been changed by hand since it was gone to. */
  #edited = false;
  /** Whether the motion that is due is to be seen from its beginning, although the case is the same. */
  #released = false;
  /** Whether the motion that is due is another case, to be seen from its beginning. */
  #fresh = true;

  constructor(
    source: Source,
    about: About,
    host: HTMLElement,
    header: HTMLElement,
    theme: ThemeSwitch,
    connection: Connection,
  ) {
    this.begun = new Promise((resolve) => (this.#begun = resolve));
    this.#source = source;
    this.#about = about;
    this.#host = host;
    this.#connection = connection;
    const [view, problem] = viewOfLink(location.hash, about);
    this.#store = new Store(view);
    const edited = (changes: Partial<View>): void => this.#edit(changes);
    const jumped = (changes: Partial<View>): void => this.#jump(changes);
    const start: JobStart = (kind, body, report, ended) => this.#job(kind, body, report, ended);
    const box = new Problems();
    this.#controls = new Controls(about, view.description, box.root, {
      edited: (description) => edited({ description }),
      started: (description, start) => edited({ description, start }),
      jumped: (description) => jumped({ description, filled: false, start: null }),
      preset: (preset) => {
        this.#given = true;
        const tab = TABS.find((one) => one === preset.view?.["tab"]) ?? this.view.tab;
        jumped({ ...viewOfPreset(preset), tab, scene: this.view.scene });
      },
      lesson: (lesson) => this.#open(lesson),
      sendRecord: source.sendRecord,
      hasBranch: branchesOf(source),
    });
    this.#lesson = new LessonCard(about, {
      changed: (description) => edited({ description }),
      gone: (lesson) => this.#open(lesson),
      closed: () => jumped({ lesson: null }),
    });
    this.#motion = new MotionView(theme.theme, {
      speed: (speed) => edited({ speed }),
      histories: (histories) => edited({ histories }),
      cancelled: () => this.#cancelRun(),
      again: () => this.#askAgain(),
      follow: () => edited({ description: { ...this.view.description, duration: null } }),
      vary: () => this.#vary(),
      pulled: (tilt) => this.#release(tilt),
      alongX: () => isPlanar(this.view.description),
    });
    this.#comparing = new Comparing(source, about, {
      changed: (compared) => this.#compare(compared),
      shown: (second) => this.#motion.showSecond(second),
      lost: (error) => this.#lose(error),
    });
    this.#motion.root.append(this.#comparing.form.root);
    this.#scene = new SceneMode(host, {
      set: (scene) => edited({ scene, time: this.view.time }),
      reset: () => this.#reset(),
    });
    this.#motion.addOver(this.#scene.root);
    this.clock.onTick((time) => this.#comparing.form.setTime(time));
    this.#problems = new CaseProblems(box, this.#controls, this.#motion);
    this.#response = new ResponseAsking(source, view, this.#scales, {
      ...{ edited, start, lost: (error) => this.#lose(error) },
      critical: (frequency) => this.#lesson.setCritical(frequency),
    });
    this.#planes = new PlanesAsking(source, about, view, this.#scales, { edited, jumped, start });
    this.#tabs = this.#newTabs();
    this.#runs = new Latest((wanted, signal) => run(source, wanted, signal), {
      answered: (found, { start }) => this.#take(found, start),
      failed: (error) => this.#fail(error),
      busy: (busy) => this.#motion.setBusy(busy),
    });
    this.#varied = new Latest((description, signal) => source.variations(description, signal), {
      answered: (found) => {
        this.#motion.showVariations(found);
        this.#lesson.setVaried(edgeOf(found));
      },
      failed: (error) => this.#motion.showVariations(error instanceof Error ? error.message : String(error)),
    });
    const menu = menuOf(source, this.#motion, () => ({ view: this.view, answer: this.#answer, shown: this.#shown }));
    header.append(menu.root, new Help().root, theme.root);
    this.#planesHost.append(this.#response.panel.root, this.#tabs.root);
    host.replaceChildren(
      this.#lesson.root,
      this.#motion.root,
      this.#controls.root,
      this.#motion.histories,
      this.#planesHost,
    );
    this.#store.onChange((now) => this.#show(now));
    window.addEventListener("popstate", () => this.#goTo(location.hash));
    listenToKeys(this.clock, { n: () => this.#motion.toNextEvent(), f: () => this.#scene.toggle() });
    this.#show(view);
    this.#problems.showLink(problem);
  }

  get clock(): Clock {
    return this.#motion.clock;
  }

  get stage(): Stage | null {
    return this.#motion.stage;
  }

  get view(): View {
    return this.#store.view;
  }

  get answer(): Answer | null {
    return this.#answer;
  }

  /** The answer about the column beside the first. */
  get secondAnswer(): Answer | null {
    return this.#motion.second?.answer ?? null;
  }

  get response(): ResponsePanel {
    return this.#response.panel;
  }

  plane(kind: PlaneKind): PlanePanel {
    return this.#planes.panels[kind];
  }

  /** Asks again for all that is shown: the server has been away. */
  refresh(): void {
    this.#asked = "";
    this.#response.forget();
    this.#comparing.forget();
    this.#show(this.view);
    this.#planes.refill();
  }

  setTheme(theme: Theme): void {
    this.#motion.setTheme(theme);
    this.#response.panel.redraw();
    this.#planes.redraw();
  }

  /** Changes the view by hand, a little at a time. */
  #edit(changes: Partial<View>): void {
    this.#problems.forgetLink();
    this.#store.change({ time: null, ...changes });
    if (this.#edited || changes.description === undefined) return this.#address.replace(this.view);
    this.#edited = true;
    this.#address.push(this.view); // the way back leads to the case as it was before it was changed
  }

  /** Goes to another case; the way back leads here. */
  #jump(changes: Partial<View>): void {
    this.#fresh = true;
    this.#edited = false;
    this.#problems.showLink(null);
    this.#address.flush();
    this.#store.change({ time: null, ...changes });
    this.#address.push(this.view);
  }

  /** Sets another column beside the first; the way back leads to the one before, or to none. */
  #compare(compared: Comparison | null): void {
    const moved = compared?.differs === this.view.compared?.differs;
    this.#address.flush();
    this.#store.change({ time: null, compared });
    if (moved) this.#address.replace(this.view);
    else this.#address.push(this.view);
  }

  #open(lesson: Lesson): void {
    this.#given = true;
    this.#jump({ ...viewOfLesson(lesson), scene: this.view.scene });
  }

  /** Begins a lesson again with its own numbers, and any other case with its motion. */
  #reset(): void {
    const lesson = this.#lessonOf(this.view);
    if (lesson === undefined) this.#motion.begin();
    else this.#open(lesson);
  }

  #lessonOf({ lesson }: View): Lesson | undefined {
    return this.#about.lessons.find((one) => one.id === lesson);
  }

  /** Goes to where the address points: a link, or a step back. */
  #goTo(link: string): void {
    const [view, problem] = viewOfLink(link, this.#about);
    this.#fresh = true;
    this.#edited = false;
    this.#given = true;
    this.#linked = true;
    this.#store.change(view);
    this.#problems.showLink(problem);
  }

  #show(view: View): void {
    setUnitsOf(view.description.column["shape"], view.lesson !== null);
    this.#controls.show(view.description, this.#scales, view.start, view.lesson);
    this.#lesson.show(view, this.#scales);
    this.#scene.show(view.scene);
    this.#host.classList.toggle("learning", view.lesson !== null);
    this.#host.classList.toggle("alone", this.#isAlone(view));
    this.#motion.setHistories(view.histories);
    this.#showSpeed(view);
    const jump = this.#fresh;
    this.#ask(view);
    this.#comparing.show(view, jump);
    // The range of the response of another column is known with its run.
    if (!jump || this.#scaled === written(view.description.column)) this.#showResponse(view, jump);
    this.#planes.show(view, this.#scales);
    this.#showTabs(view);
    this.#motion.offerVariations(this.#source.offers("variations", sent(view.description)));
    // Where the case is shown already, as after a step back to another tab, there is no answer to wait for.
    if (this.#shown === written(view.description)) this.#settle();
  }

  #showTabs({ tab }: View): void {
    const offered = (name: Tab): boolean => !isPlaneKind(name) || this.#planes.offers(name);
    this.#tabs.show(tab, offered);
    this.#planesHost.classList.toggle("mapped", isPlaneKind(tab) && offered(tab));
  }

  /** Whether a lesson has no curves and no maps beside its motion. */
  #isAlone(view: View): boolean {
    const lesson = this.#lessonOf(view);
    return lesson !== undefined && lesson.curves !== true;
  }

  #showResponse(view: View, jump: boolean): void {
    if (!this.#isAlone(view)) this.#response.show(view, this.#scales, jump);
  }

  #ask(view: View): void {
    const { description } = view;
    // A preset or a link has the start of its branch; it is asked for once something else has changed.
    if (this.#given && description["tilt"] !== undefined)
      this.#started = { description, start: view.start, remarks: [] };
    this.#given = false;
    const kept = this.#startsOn(view);
    const start = kept ? null : view.start;
    const wanted = written([description, start]);
    if (wanted === this.#asked) return;
    this.#asked = wanted;
    if (this.#fresh && this.#answer !== null) this.#motion.setStale(true);
    const remarks = kept ? (this.#started?.remarks ?? []) : [];
    this.#runs.want({ description, start, remarks }, { jump: this.#fresh });
  }

  /** Whether the start that is set is the one on the branch that the view follows. */
  #startsOn({ description, start }: View): boolean {
    const started = this.#started;
    return started !== null && started.start === start && startAlike(started.description, description);
  }

  #showSpeed(view: View): void {
    // The picture keeps the speed of its own case until another one is shown.
    const usual = this.#answer === null ? 1 : paceOf(this.#moved, this.#answer);
    this.#motion.setSpeed(view.speed ?? usual);
  }

  #take(found: Run, start: Branch | null): void {
    const { answer, description } = found;
    this.#varied.cancel(); // they were those of the run before
    this.#answer = answer;
    this.#shown = written(description);
    this.#moved = description.motion;
    this.#problems.clear();
    this.#rescale(answer.column, description.column);
    this.#motion.setStale(false);
    this.#motion.show(answer, description);
    this.#lesson.setOutcome(answer.outcome);
    this.#showSpeed(this.view);
    if (this.#fresh || (this.#released && this.#shown === written(this.view.description))) this.#begin();
    if (start !== null) this.#takeStart(found, start);
    this.#settle();
    this.#begun();
  }

  #begin(): void {
    this.#released = false;
    this.#motion.begin();
  }

  /** The column was pulled by hand: it starts at this tilt, from rest. */
  #release(tilt: Pair): void {
    this.#released = true;
    this.#asked = ""; // also where it was let go at the tilt at which it started before
    const start = tilt.map((one) => Number(one.toPrecision(4)));
    this.#edit({ description: { ...standing(this.view.description), tilt: start }, start: null });
  }

  /** Asks for small variations of the run that is shown. */
  #vary(): void {
    this.#motion.showVariations("Computing 64 small variations…");
    this.#varied.want(sent(this.view.description), { jump: true });
  }

  /** A start on a branch that was asked for, unless the case has changed since. */
  #takeStart({ description, remarks }: Run, start: Branch): void {
    const { view } = this;
    if (view.start !== start || !startAlike(view.description, description)) return;
    this.#started = { description, start, remarks };
    this.#asked = written([description, null]);
    this.#store.change({ description: { ...view.description, ...startOf(description) } });
    this.#address.replace(this.view);
  }

  /** What depends on the column's own tilt and frequency, once they are known. */
  #rescale(found: ColumnScales, column: Part): void {
    if (this.#scaled === written(column)) return;
    this.#scaled = written(column);
    this.#scales = found;
    this.#controls.show(this.view.description, found, this.view.start, this.view.lesson);
    this.#showResponse(this.view, this.#fresh);
    this.#planes.show(this.view, found);
  }

  /** The case that was due is shown. */
  #settle(): void {
    this.#fresh = false;
    if (!this.#linked) return;
    this.#linked = false;
    if (this.view.time !== null) this.#motion.stopAt(this.view.time);
    this.#planes.refill();
  }

  #fail(error: unknown): void {
    if (error instanceof Unreachable) return this.#lose(error);
    const lines = error instanceof Refused ? error.problems : [String(error)];
    if (lines.some((line) => line.startsWith("motion.upload"))) void this.#restoreRecord();
    else if (this.#answer === null && !this.#problems.ofLink) this.#replaceLink(lines);
    else this.#stay(lines);
  }

  #cancelRun(): void {
    this.#runs.cancel();
    this.#stay(["The run was cancelled. Change the case or compute it again."], true);
  }

  /** Shows why there is no run of the case, and its response all the same. */
  #stay(lines: readonly string[], again = false): void {
    this.#problems.show(lines, { earlier: this.#answer !== null, again });
    this.#showResponse(this.view, this.#fresh);
  }

  /** Asks once more for a case whose run was cancelled. */
  #askAgain(): void {
    this.#asked = "";
    this.#problems.clear();
    this.#ask(this.view);
  }

  /** A link whose case cannot be run leaves nothing to look at: the first preset is shown, and what was wrong. */
  #replaceLink(lines: readonly string[]): void {
    this.#fresh = true;
    this.#given = true;
    this.#store.change(firstView(this.#about));
    this.#problems.showLink(inWords(lines.join("; ")));
  }

  /** The server forgets records when it ends; what was uploaded here is sent once more. */
  async #restoreRecord(): Promise<void> {
    const restored = await this.#controls.record.restore(this.view.description.motion["upload"]).catch(() => false);
    if (restored) return this.refresh();
    this.#controls.record.askAgain();
    this.#stay([NOT_HERE]);
  }

  #lose(error: Unreachable): void {
    this.#asked = "";
    this.#connection.lose(error);
  }

  #job(...[kind, body, report, ended]: Parameters<JobStart>): Job {
    return new Job(this.#source, kind, body, {
      report,
      ended: (last, error) => {
        if (error instanceof Unreachable) this.#lose(error);
        ended(last, problemsIn(last, error));
      },
    });
  }

  #newTabs(): Tabs<Tab> {
    return new Tabs<Tab>(
      "Planes",
      [
        { name: "orbit", title: "Tilt path", panel: this.#motion.orbit.root },
        ...PLANE_KINDS.map((kind) => ({ name: kind, title: PLANES[kind][0], panel: this.plane(kind).root })),
        { name: "numbers", title: "Numbers", panel: this.#motion.numbers.root },
      ],
      (tab) => {
        this.#edit({ tab, filled: isPlaneKind(tab) && this.plane(tab).current });
        if (isPlaneKind(tab)) this.#planes.open(tab);
      },
    );
  }
}
