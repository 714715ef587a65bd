/** Scenes, robots and questions against a real daemon. What is expected is worked out by hand: balls and boxes along axes. */

import assert from "node:assert/strict";
import test from "node:test";

import {
  addBody,
  addRobot,
  allLinks,
  allowCollision,
  at,
  ballSwept,
  box,
  capsule,
  clearBox,
  compound,
  cone,
  convex,
  cylinder,
  ellipsoid,
  declareEffects,
  everything,
  group,
  halfSpace,
  insertPoints,
  InvalidRequest,
  mesh,
  moveBody,
  moveRobot,
  NotFound,
  oneBody,
  oneLink,
  plane,
  pointCloud,
  pointOf,
  refused,
  removeBody,
  removeRobot,
  replaceShape,
  setEnabled,
  setPairMargin,
  sphere,
  v1,
  verdictOf,
  voxels,
  type Point,
  type ShapeInit,
} from "clearance";
import { readRobot } from "clearance/node";

import { CRANE } from "./crane.js";
import { client, daemon, thrown, UR5 } from "./daemon.js";

function tightlyAround(truth: number, bracket: v1.Bracket | undefined): void {
  assert.ok(bracket !== undefined && bracket.lower <= truth && truth <= bracket.upper && bracket.upper - bracket.lower < 1e-6);
}

test("distance and depth of balls", async (t) => {
  const asking = client(t, await daemon(t));
  const scene = await asking.createScene("cell");
  const applied = await scene.apply([addBody("a", sphere(0.5)), addBody("b", ballSwept(sphere(0.25), 0.25), at(3, 0, 0))]);
  assert.equal(applied.revision, 1n);
  const apart = (await scene.distance()).items[0]?.nearest;
  tightlyAround(2, apart?.bracket);
  assert.ok(Math.abs(pointOf(apart?.witness?.pointOnB)[0] - 2.5) < 1e-9);
  assert.equal(apart?.derivatives, undefined);
  const exact = (await scene.distance([], { derivatives: {} })).items[0]?.nearest?.derivatives;
  assert.equal(exact?.method, v1.DerivativeMethod.EXACT);
  assert.deepEqual([exact.ofB?.signedDistance.map((x) => Math.round(x) + 0), exact.ofB?.normal.length], [[1, 0, 0, 0, 0, 0], 18]);
  assert.ok(Math.abs(exact.conditioning - 3) < 1e-9);
  const differences = { method: v1.DerivativeMethod.FINITE_DIFFERENCE };
  const told = (await scene.distance([], { derivatives: differences })).items[0]?.nearest?.derivatives;
  assert.deepEqual([told?.method, told?.conditioning], [differences.method, NaN]);
  const inside = { shape: sphere(0.1), pose: at(0.5, 0, 0) };
  const [probed] = (await scene.distance([inside], { want: "depth" })).items;
  assert.equal(probed?.verdict, v1.Verdict.COLLISION);
  tightlyAround(-0.1, probed.nearest?.bracket);
  const [ignoring] = (await scene.collide([inside], { ignore: ["a"] })).items;
  assert.equal(ignoring?.verdict, v1.Verdict.FREE);
  const [near] = (await scene.clearance(2.1)).items;
  assert.deepEqual(near?.pairs.map((pair) => pair.a?.kind.value), [apart?.a?.kind.value]);
  assert.equal((await scene.clearance(1.9)).items[0]?.pairs.length, 0);
  assert.deepEqual((await scene.contents()).bodies.map((body) => body.name), ["a", "b"]);
  assert.deepEqual((await asking.listScenes()).map((summary) => summary.name), ["cell"]);
  assert.ok((await asking.serverInfo()).threads > 0);
});

test("every edit and every shape is taken", async (t) => {
  const asking = client(t, await daemon(t));
  const scene = await asking.createScene("cell");
  const model = await asking.loadRobot({ urdf: CRANE });
  const corners: Point[] = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const shapes: Record<string, ShapeInit> = {
    sphere: sphere(0.1),
    box: box([0.1, 0.2, 0.3]),
    capsule: capsule(0.1, 0.2),
    cylinder: cylinder(0.1, 0.2),
    cone: cone(0.1, 0.2),
    ellipsoid: ellipsoid([0.1, 0.2, 0.3]),
    convex: convex(corners),
    mesh: mesh(corners, [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], v1.MeshMode.SOLID),
    compound: compound([{ shape: sphere(0.1), pose: at(1, 0, 0) }, { shape: box([1, 1, 1]) }]),
    point_cloud: pointCloud(corners, 0.01),
    voxels: voxels(0.1),
    half_space: halfSpace([0, 0, 1], -50),
    plane: plane([1, 0, 0], 90),
  };
  const edits = Object.entries(shapes).map(([kind, shape], i) => addBody(kind, shape, at(3 * i, 0, 5), { groups: ["things"] }));
  const applied = await scene.apply(edits);
  for (const body of (await scene.contents()).bodies) {
    assert.equal(body.shapeKind, body.name);
    assert.deepEqual(body.groups, ["things"]);
  }
  const more = [
    addRobot("arm", model),
    moveRobot("arm", at(-50, 0, 0)),
    moveBody("box", at(0, 50, 0)),
    moveBody(applied.added[0] as bigint, at(0, 60, 0)),
    replaceShape("cone", sphere(0.2)),
    insertPoints("voxels", corners),
    clearBox("voxels", [-1, -1, -1], [2, 2, 0.5]),
    setEnabled("mesh", false),
    allowCollision(oneBody("box"), allLinks("arm")),
    allowCollision(oneLink("arm", "boom"), group("fixtures"), false),
    setPairMargin(oneBody("box"), everything(), 0.1),
    declareEffects(oneBody("box"), everything(), [v1.Effect.MARGIN]),
    removeBody("plane"),
  ];
  const once = { expectedRevision: applied.revision, expectedEpoch: applied.epoch, idempotencyKey: "once" };
  // The same key again is answered, not applied.
  assert.equal((await scene.apply(more, once)).revision, (await scene.apply(more, once)).revision);
  const contents = await scene.contents();
  assert.deepEqual([contents.robots.length, contents.bodies.length], [1, Object.keys(shapes).length - 1]);
  await scene.apply([removeRobot("arm")]);
  assert.equal((await scene.contents()).robots.length, 0);
});

test("states, motions and paths of a robot", async (t) => {
  const asking = client(t, await daemon(t));
  const scene = await asking.createScene("cell");
  const robot = await asking.loadRobot({ urdf: CRANE });
  assert.deepEqual([robot.degreesOfFreedom, robot.links], [2, ["foot", "boom", "hook"]]);
  assert.deepEqual([[...robot.lower], [...robot.upper]], [[-3, -1], [3, 0]]);
  const applied = await scene.apply([addRobot("crane", robot), addBody("wall", box([0.1, 0.5, 0.5]), at(0, 1, 0))]);
  const states = [[0, -0.5], [Math.PI / 2, -0.5], [-1, -0.5]];
  const checked = await scene.checkStates("crane", states, { atLeast: applied.revision });
  assert.deepEqual(checked.verdicts, ["FREE", "COLLISION", "FREE"]);
  assert.deepEqual([checked.stoppedAt, checked.outOfTime], [undefined, false]);
  assert.ok((checked.cost?.pairs ?? 0n) > 0n && (checked.nearest.lower[0] ?? 0) > 0);
  const first = await scene.checkStates("crane", states, { stopAtFirst: true, want: "verdict" });
  assert.deepEqual([first.stoppedAt, first.verdicts[2], first.nearestSelf.lower.length], [1, "NOT_RUN", 0]);
  const [seen] = (await scene.lookAtStates("crane", states.slice(1, 2))).items;
  assert.ok(seen?.pairs[0]?.witness !== undefined);
  const motions = await scene.checkMotions("crane", states.slice(0, 2), [[0.2, -0.5], [1, -0.5]]);
  assert.deepEqual(motions.verdicts, ["FREE", "COLLISION"]);
  assert.deepEqual([motions.freeUntil[0], motions.reachedFrom[0], motions.reachedTo[1]], [1, NaN, 0]);
  const path = await scene.checkPath("crane", [[-1, 0], [0, 0], [Math.PI / 2, 0], [3, 0]]);
  assert.deepEqual([path.stoppedAt, path.verdicts[2]], [1, "NOT_RUN"]);
  const [near] = (await scene.clearanceOfStates("crane", states.slice(0, 1), 10, { maxPairs: 1 })).items;
  assert.deepEqual([near?.pairs.length, near?.truncated], [1, true]);
  // Only this question sees the wall elsewhere.
  const whatIf = { edits: [moveBody("wall", at(0, 9, 0))] };
  assert.deepEqual((await scene.checkStates("crane", states.slice(1, 2), { whatIf })).verdicts, ["FREE"]);
  await assert.rejects(scene.checkStates("crane", [[0, 0], [0]]), RangeError);
  await assert.rejects(scene.checkStates("crane", [[0, 0, 0, 0]]), RangeError);
  await assert.rejects(scene.checkMotions("crane", states, []), RangeError);
});

test("meshes are uploaded once", async (t) => {
  const asking = client(t, await daemon(t));
  const description = await readRobot(`${UR5}/ur5.urdf`, `${UR5}/ur5.srdf`);
  assert.equal(description.meshes?.size, 17);
  assert.equal((await asking.loadRobot(description)).id, (await asking.loadRobot(description)).id);
  // More than one message, and a file that is there twice.
  const large = new Uint8Array(2_700_000).fill(7);
  const hashes = await asking.upload([large, new Uint8Array([1, 2]), large]);
  assert.equal(new Set(hashes).size, 2);
  assert.deepEqual((await asking.assets.hasAssets({ sha256: hashes })).present, [true, true, true]);
  await assert.rejects(readRobot(`${UR5}/ur5.urdf`, undefined, { ur5: "/nowhere" }), /\/nowhere\/meshes\/base_link_0.obj/);
  await assert.rejects(asking.loadRobot({ urdf: "<robot" }), InvalidRequest);
});

test("streams of the generated stubs", async (t) => {
  const asking = client(t, await daemon(t));
  const scene = await asking.createScene("cell");
  await scene.apply([addBody("a", sphere(1))]);
  const watch = asking.scenes.watch({ scene: "cell" })[Symbol.asyncIterator]();
  const step = (await watch.next()).value as v1.WatchResponse;
  assert.deepEqual([step.revision, step.bodies.length], [1n, 1]);

  async function* questions() {
    const items = [{ kind: { case: "shape" as const, value: { shape: sphere(1), pose: at(1, 0, 0) } } }];
    yield { question: { case: "options" as const, value: { inOrder: true } } };
    yield { id: 7n, question: { case: "collide" as const, value: { context: scene.context(), items } } };
    yield { id: 8n, question: { case: "collide" as const, value: { context: scene.context({ margin: -1 }), items } } };
  }
  const answers = [];
  for await (const answer of asking.queries.queryStream(questions())) answers.push(answer);
  assert.deepEqual(answers.map((answer) => answer.id), [7n, 8n]);
  const [first, second] = answers.map((answer) => answer.outcome);
  assert.equal(first?.case === "collide" && verdictOf(first.value.answer?.items[0]?.verdict ?? 0), "COLLISION");
  const error = second?.case === "error" ? refused(second.value) : undefined;
  assert.ok(error instanceof InvalidRequest);
  assert.deepEqual([error.code, error.reason, error.field], ["INVALID_ARGUMENT", "INVALID_FIELD", "context.margin"]);

  await scene.delete();
  await thrown(NotFound, watch.next());
});
