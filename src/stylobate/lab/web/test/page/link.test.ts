import assert from "node:assert/strict";
import { test } from "node:test";
import type { Description, Part } from "../../src/page/case/description";
import { BrokenLink, linkOf, viewFrom } from "../../src/page/view/link";
import { viewOf, type View } from "../../src/page/view/state";
import { ABOUT, VIEW } from "./case";

const again = (view: View): View => viewFrom(`#${linkOf(view)}`, ABOUT);

const under = (motion: Part): View => viewOf({ ...VIEW.description, motion } as Description);

test("a link describes its case in words that can be read", () => {
  assert.equal(
    linkOf(VIEW),
    "column=dimensionless,slenderness:0.1&model=slender,damping:0.1&motion=circular,acceleration:0.065,angular_frequency:1.8" +
      "&tilt=0.0386,-0.004&tilt_rate=-0.0075,0.0695&duration=60",
  );
});

test("a link brings back the view it was made of", () => {
  const axis = { from: 0.5, to: 6, number: 48 };
  const map = { x: { name: "angular_frequency", ...axis }, y: { name: "acceleration", ...axis } };
  const basin = { x: { name: "tilt_x", ...axis, from: -0.1 }, y: { name: "tilt_y", ...axis, from: -1e-7 } };
  const view: View = {
    ...VIEW,
    range: [0.2, 4],
    map,
    basin,
    tab: "map",
    filled: true,
    speed: 0.25,
    start: "lower",
    time: 12.5,
    scene: true,
    histories: ["base_x", "tilt"],
  };
  assert.deepEqual(again(view), view);
  assert.deepEqual(again(VIEW), VIEW);
});

test("a lesson or a preset can be handed out with its scene alone", () => {
  const preset = { id: "case", title: "", about: "", description: VIEW.description, view: {} };
  const lesson = { ...preset, id: "one", question: "", task: "", said: {}, control: {} };
  const about = { ...ABOUT, presets: [preset], lessons: [lesson] };
  for (const link of [`lesson=${lesson.id}`, `case=${preset.id}`]) {
    assert.deepEqual(viewFrom(`#${link}&view=scene`, about), { ...viewFrom(`#${link}`, about), scene: true });
    assert.equal(viewFrom(`#${link}`, about).scene, false);
  }
  assert.throws(() => viewFrom(`#lesson=${lesson.id}&view=chart`, about), BrokenLink);
});

test("a preset alone is a link", () => {
  const preset = { id: "p", title: "", about: "", view: { start: "upper" }, description: VIEW.description };
  const about = { ...ABOUT, presets: [preset] };
  const opened = viewFrom("#case=p", about);
  assert.deepEqual([opened.lesson, opened.start, opened.description], [null, "upper", VIEW.description]);
  assert.throws(() => viewFrom("#case=unknown", about), BrokenLink);
});

test("a lesson alone is a link, and a map keeps the start of its runs", () => {
  const lesson = { id: "l", title: "", question: "", task: "", control: {}, said: {}, view: { start: "upper" } };
  const about = { ...ABOUT, lessons: [{ ...lesson, description: VIEW.description }] };
  const opened = viewFrom("#lesson=l", about);
  assert.deepEqual([opened.lesson, opened.start, opened.description], ["l", "upper", VIEW.description]);
  assert.throws(() => viewFrom("#lesson=unknown", about), BrokenLink);
  const axis = { from: 0.5, to: 6, number: 48 };
  const map = {
    x: { name: "angular_frequency", ...axis },
    y: { name: "acceleration", ...axis },
    start: "upper",
  } as const;
  assert.deepEqual(again({ ...VIEW, map }).map, map);
});

const MOTIONS: readonly Part[] = [
  { kind: "record", sample: "el centro 1940", scale: 1.5 },
  { kind: "record", upload: "1e5", scale: 1 },
  { kind: "record", upload: "0123abc", scale: 1 },
  { kind: "elliptic", amplitude: [1, -0.25], angular_frequency: 2 },
  { kind: "elliptic", amplitude: [1], angular_frequency: 2e-7 },
  { kind: "sum", motions: [{ kind: "circular", acceleration: 1, angular_frequency: 2 }, { kind: "rest" }] },
  { kind: "record", sample: "none", scale: 1 },
  { kind: "record", sample: "50 % & more, = it: ~'/#", scale: 1 },
  { kind: "record", sample: "Ωμ", scale: 1 },
];

for (const motion of MOTIONS) {
  test(`a link brings back the motion ${JSON.stringify(motion)}`, () => {
    assert.deepEqual(again(under(motion)).description.motion, motion);
  });
}

test("a link survives being written into an address", () => {
  for (const motion of MOTIONS) {
    const address = new URL(`http://localhost/#${linkOf(under(motion))}`);
    assert.deepEqual(viewFrom(address.hash, ABOUT).description.motion, motion);
  }
});

const BROKEN: readonly (readonly [link: string, message: RegExp])[] = [
  ["#column", /column has no value/],
  ["#model=slender", /column is missing/],
  ["#column=cube", /column cube is not known/],
  ["#column=solid,colour:1", /column solid has no colour/],
  ["#column=solid&wind=3", /wind is not known/],
  ["#column=solid,radius:1..2", /1\.\.2 is no number/],
  ["#column=solid,radius", /column radius has no value/],
  ["#column=solid&tab=garden", /tab must be one of/],
  ["#column=solid&range=4,1", /range must be two rising/],
  ["#column=solid&map=tilt_x:0:1:8", /map must be two axes/],
  ["#column=solid&map=tilt_x:0:1:8,tilt_x:0:1:8", /map must be two axes/],
  ["#column=solid&speed=fast", /speed must be positive/],
  ["#column=solid&start=soon", /start must be one of upper, lower/],
  ["#column=solid&motion=record,sample:%E0%A4%A", /not well formed/],
  ["#column=solid&motion=sum,motions:~%5B", /not well formed/],
];

for (const [link, message] of BROKEN) {
  test(`the link ${link} is reported as broken`, () => {
    assert.throws(
      () => viewFrom(link, ABOUT),
      (error) => error instanceof BrokenLink && message.test(error.message),
    );
  });
}
