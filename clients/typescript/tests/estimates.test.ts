/** What questions would cost. Oracle: verdicts worked out by hand, and the tolerances themselves; of times, that they are there. */

import assert from "node:assert/strict";
import test, { type TestContext } from "node:test";

import { addBody, addRobot, at, box, cone, InvalidRequest, moveBody, v1, type Prices, type Question, type Scene } from "clearance";

import { CRANE } from "./crane.js";
import { client, daemon, thrown } from "./daemon.js";

const CONES = ["a", "b", "c"];

/** Three cones in a row, 2 m from one to the next, each turned otherwise: their brackets have to be narrowed. */
async function cones(t: TestContext): Promise<Scene> {
  const scene = await client(t, await daemon(t)).createScene("cell");
  await scene.apply(CONES.map((name, i) => addBody(name, cone(0.3, 0.4), at(2 * i, 0, 0, [1, 0, 0.3 * i, 0]))));
  return scene;
}

function measured(told: v1.EstimateResponse): void {
  for (const { complete, meanCost, times } of told.rows) {
    assert.ok(complete && meanCost !== undefined && times !== undefined);
    assert.ok(0n < times.median && times.median <= times.p99);
  }
}

test("an estimate has a row for each tolerance", async (t) => {
  const scene = await cones(t);
  const tolerances = [1e-2, 1e-6];
  const outputs = [v1.Output.DISTANCE];
  const told = await scene.estimateDistance(CONES, { tolerances, outputs });
  assert.deepEqual([told.items, told.sample, told.revision, told.end], [3n, 3n, 1n, v1.EstimateEnd.COMPLETE]);
  assert.deepEqual(told.rows.map((row) => [row.output, row.tolerance]), tolerances.map((tolerance) => [v1.Output.DISTANCE, tolerance]));
  measured(told);
  for (const { tolerance, verdicts, widths } of told.rows) {
    assert.deepEqual([verdicts?.free, widths?.items, widths?.wider], [3n, 3n, 0n]);
    assert.ok((widths?.largest ?? Infinity) <= (tolerance ?? 0));
  }
  // Of a sample, on the daemon's ladder.
  const ladder = await scene.estimateDistance(CONES, { outputs, sample: 2 });
  assert.deepEqual([ladder.sample, ladder.rows.length, ladder.rows[0]?.tolerance, ladder.rows[9]?.tolerance], [2n, 10, 0.1, 0]);
  // No machine has measured anything after a nanosecond.
  const hurried = await scene.estimateDistance(CONES, { tolerances, time: 1e-9 });
  assert.deepEqual([hurried.end, hurried.rows[0]?.times], [v1.EstimateEnd.TIME, undefined]);
});

test("an estimate is of the question as it is asked", async (t) => {
  const scene = await cones(t);
  const tolerances = [1e-3];
  const prices: Prices = { tolerances, outputs: [v1.Output.DISTANCE] };
  const counts = async (question: Question) => (await scene.estimateDistance(CONES, prices, question)).rows[0]?.verdicts;
  assert.equal((await counts({ margin: 10, stopAtFirst: true }))?.margin, 3n);
  const what = await counts({ whatIf: { edits: [moveBody("a", at(2, 0, 0))] } });
  assert.deepEqual([what?.collision, what?.free], [2n, 1n]);
  // Cones are nothing for separating axes.
  assert.equal((await counts({ context: { solver: v1.Solver.SAT } }))?.invalidInput, 3n);
  // Each question has its own outputs; without subjects all pairs are one item.
  const touching = await scene.estimateCollide([], { tolerances });
  assert.deepEqual([touching.items, touching.rows.length], [1n, 6]);
  const near = await scene.estimateClearance(2, CONES, { tolerances });
  assert.deepEqual([near.items, near.rows.length], [3n, 5]);
});

test("estimates of a robot", async (t) => {
  const asking = client(t, await daemon(t));
  const scene = await asking.createScene("cell");
  const robot = await asking.loadRobot({ urdf: CRANE });
  await scene.apply([addRobot("crane", robot), addBody("wall", box([0.1, 0.5, 0.5]), at(0, 1, 0))]);
  const prices = { tolerances: [1e-2, 1e-3] };
  const states = [[0, -0.5], [Math.PI / 2, -0.5], [-1, -0.5]];
  // Verdict and pairs, which no tolerance changes; distance, witness, depth, patch and derivatives.
  const of = await scene.estimateStates("crane", states, prices);
  assert.deepEqual([of.items, of.rows.length], [3n, 2 + 5 * 2]);
  assert.deepEqual([of.rows[0]?.output, of.rows[0]?.tolerance], [v1.Output.VERDICT, undefined]);
  assert.deepEqual([of.rows[0]?.verdicts?.free, of.rows[0]?.verdicts?.collision], [2n, 1n]);
  const motions = await scene.estimateMotions("crane", states.slice(0, 2), [[0.2, -0.5], [1, -0.5]], prices);
  assert.deepEqual([motions.items, motions.rows.length, motions.rows[0]?.tolerance], [2n, 6 * 2, 1e-2]);
  assert.deepEqual([motions.rows[0]?.verdicts?.free, motions.rows[0]?.verdicts?.collision], [1n, 1n]);
  const path = await scene.estimatePath("crane", [[-1, 0], [0, 0], [Math.PI / 2, 0], [3, 0]], prices);
  assert.deepEqual([path.items, path.rows.length], [3n, 6 * 2]);
  for (const told of [of, motions, path]) measured(told);
  await assert.rejects(scene.estimateStates("crane", [[0, 0], [0]], prices), RangeError);
  await assert.rejects(scene.estimateStates("crane", [[0, 0, 0, 0]], prices), RangeError);
  await assert.rejects(scene.estimateMotions("crane", states, [], prices), RangeError);
});

test("what cannot be estimated is named", async (t) => {
  const scene = await cones(t);
  const field = async (prices: Prices, question: Question = {}) =>
    (await thrown(InvalidRequest, scene.estimateDistance(CONES, prices, question))).field;
  assert.equal(await field({ tolerances: [1, NaN] }), "tolerances[1]");
  assert.equal(await field({}, { margin: -1 }), "question.context.margin");
  assert.equal(await field({ outputs: [v1.Output.VERDICT] }), "outputs[0]");
});
