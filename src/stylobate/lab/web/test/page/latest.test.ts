import assert from "node:assert/strict";
import { mock, test } from "node:test";
import { Latest } from "../../src/page/server/latest";

/** A server whose answers are given by hand. */
function byHand() {
  const sent: {
    wanted: number;
    answer: (text: string) => void;
    refuse: (error: Error) => void;
    signal: AbortSignal;
  }[] = [];
  const heard: string[] = [];
  const latest = new Latest<number, string>(
    (wanted, signal) => new Promise((answer, refuse) => sent.push({ wanted, answer, refuse, signal })),
    { answered: (text) => heard.push(text), failed: (error) => heard.push(String(error)) },
  );
  return { sent, heard, latest };
}

const soon = () => new Promise((resolve) => setTimeout(resolve, 0));

test("while one is asked for, only the newest of the others waits", async () => {
  const { sent, heard, latest } = byHand();
  for (const wanted of [1, 2, 3, 4]) latest.want(wanted);
  assert.deepEqual(
    sent.map((one) => one.wanted),
    [1],
  );
  sent[0]!.answer("one");
  await soon();
  assert.deepEqual(
    sent.map((one) => one.wanted),
    [1, 4],
  );
  sent[1]!.answer("four");
  await soon();
  assert.deepEqual(heard, ["one", "four"]);
});

test("after a jump the answer to what was asked before is not heard", async () => {
  const { sent, heard, latest } = byHand();
  latest.want(1);
  latest.want(2, { jump: true });
  sent[0]!.answer("one");
  await soon();
  sent[1]!.answer("two");
  await soon();
  assert.deepEqual(heard, ["two"]);
});

test("after a refusal the next is asked all the same", async () => {
  const { sent, heard, latest } = byHand();
  latest.want(1);
  latest.want(2);
  sent[0]!.refuse(new Error("no"));
  await soon();
  sent[1]!.answer("two");
  await soon();
  assert.deepEqual(heard, ["Error: no", "two"]);
});

test("what is cancelled is neither asked nor heard", async () => {
  const { sent, heard, latest } = byHand();
  latest.want(1);
  latest.want(2);
  latest.cancel();
  sent[0]!.answer("one");
  await soon();
  assert.deepEqual([sent.length, heard.length], [1, 0]);
});

test("a request that a jump makes idle is broken off if it takes long, and not before", () => {
  mock.timers.enable({ apis: ["setTimeout"] });
  const { sent, latest } = byHand();
  latest.want(1);
  latest.want(2, { jump: true });
  mock.timers.tick(1000);
  assert.ok(!sent[0]!.signal.aborted);
  mock.timers.tick(1000);
  assert.ok(sent[0]!.signal.aborted);
  mock.timers.reset();
});
