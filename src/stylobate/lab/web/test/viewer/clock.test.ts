import assert from "node:assert/strict";
import { afterEach, beforeEach, test } from "node:test";
import { Clock } from "../../src/viewer/clock";

/** A screen whose frames come when the test says so. */
class Screen {
  readonly #waiting = new Map<number, (now: number) => void>();
  #number = 0;
  lessMotion = false;

  request = (call: (now: number) => void): number => {
    this.#number += 1;
    this.#waiting.set(this.#number, call);
    return this.#number;
  };

  cancel = (number: number): void => void this.#waiting.delete(number);

  frame(now: number): void {
    const calls = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const call of calls) call(now);
  }
}

let screen = new Screen();

beforeEach(() => {
  screen = new Screen();
  Object.assign(globalThis, {
    requestAnimationFrame: screen.request,
    cancelAnimationFrame: screen.cancel,
    matchMedia: () => ({ matches: screen.lessMotion }),
  });
});
afterEach(() => {
  for (const name of ["requestAnimationFrame", "cancelAnimationFrame", "matchMedia"])
    delete (globalThis as Record<string, unknown>)[name];
});

function running(to = 10): Clock {
  const clock = new Clock();
  clock.setRange(0, to);
  clock.play();
  screen.frame(1000);
  return clock;
}

test("the time shown runs with the frames, at the speed that is set", () => {
  const clock = running();
  screen.frame(1050);
  assert.ok(Math.abs(clock.time - 0.05) < 1e-12);
  clock.speed = 4;
  screen.frame(1100);
  assert.ok(Math.abs(clock.time - 0.25) < 1e-12);
});

test("at the end it stops, and playing again starts over", () => {
  const clock = running(0.08);
  screen.frame(1090);
  assert.deepEqual([clock.time, clock.playing], [0.08, false]);
  clock.play();
  assert.deepEqual([clock.time, clock.playing], [0, true]);
});

test("a page that was hidden goes on where it was", () => {
  const clock = running();
  screen.frame(61_000);
  assert.ok(clock.time <= 0.1 + 1e-12);
});

test("pausing stops the frames; seeking stays within the range", () => {
  const clock = running();
  clock.pause();
  screen.frame(1100);
  assert.deepEqual([clock.time, clock.playing], [0, false]);
  clock.seek(99);
  assert.equal(clock.time, 10);
  clock.setRange(2, 5);
  assert.equal(clock.time, 5);
});

test("listeners hear each frame, each seek and each change of playing, until they leave", () => {
  const clock = new Clock();
  clock.setRange(0, 10);
  const heard: number[] = [];
  const leave = clock.onTick((time) => heard.push(time));
  clock.play();
  screen.frame(0);
  clock.seek(3);
  clock.pause();
  leave();
  clock.seek(4);
  assert.deepEqual(heard, [0, 0, 3, 3]);
});

test("nothing plays by itself for those who asked for less motion", () => {
  const clock = new Clock();
  clock.setRange(0, 10);
  screen.lessMotion = true;
  clock.autoplay();
  assert.equal(clock.playing, false);
  screen.lessMotion = false;
  clock.autoplay();
  assert.equal(clock.playing, true);
});
