/** What a refused call throws. */

import assert from "node:assert/strict";
import test from "node:test";

import {
  addBody,
  at,
  ClearanceError,
  Conflict,
  DeadlineExceeded,
  InvalidRequest,
  LimitExceeded,
  moveBody,
  NotFound,
  removeBody,
  RevisionGone,
  sphere,
  Unavailable,
} from "clearance";

import { client, daemon, thrown } from "./daemon.js";

test("errors say what", async (t) => {
  const asking = client(t, await daemon(t, "limits.max_items = 3\n"));
  const scene = await asking.createScene("cell");
  await scene.apply([addBody("a", sphere(1))]);

  const invalid = await thrown(InvalidRequest, scene.apply([moveBody("a", at(0, 0, 1)), addBody("b", sphere(NaN))]));
  assert.deepEqual([invalid.item, invalid.field], [1, "edits[1].add_body.shape.sphere.radius"]);
  assert.deepEqual([invalid.code, invalid.reason, invalid.name], ["INVALID_ARGUMENT", "INVALID_FIELD", "InvalidRequest"]);
  assert.match(invalid.message, /^INVALID_ARGUMENT: edits\[1\]/);
  const taken = await thrown(Conflict, asking.createScene("cell"));
  assert.deepEqual([taken.reason, taken.item], ["ALREADY_EXISTS", undefined]);
  const moved = await thrown(Conflict, scene.apply([removeBody("a")], { expectedRevision: 7n }));
  assert.deepEqual([moved.reason, moved.revision], ["REVISION_MOVED_ON", 1n]);
  await thrown(NotFound, asking.scene("nowhere").distance());
  const limit = await thrown(LimitExceeded, scene.collide(["a", "a", "a", "a"]));
  assert.deepEqual([limit.limit, limit.asked, limit.allowed], ["max_items", 4, 3]);

  for (let i = 0; i < 65; i += 1) await scene.apply([moveBody("a", at(i, 0, 0))]);
  const gone = await thrown(RevisionGone, scene.distance([], { exactly: 1n }));
  assert.ok(gone.oldestRevision !== undefined && gone.oldestRevision > 1n);

  // The daemon and the client count the same deadline; either may be the first to tell.
  const late = await thrown(ClearanceError, scene.distance([], { atLeast: 1000n, timeoutMs: 50 }));
  assert.ok(late instanceof DeadlineExceeded || late instanceof Unavailable, String(late));
  const stopped = await thrown(ClearanceError, scene.distance([], { atLeast: 1000n, signal: AbortSignal.timeout(50) }));
  assert.ok(["CANCELED", "DEADLINE_EXCEEDED"].includes(stopped.code), stopped.code);
});

test("a rate limit says when to ask again", async (t) => {
  const asking = client(t, await daemon(t, "limits.max_client_items_per_second = 2\n"));
  const scene = await asking.createScene("cell");
  const adding = async () => {
    for (let i = 0; i < 1000; i += 1) await scene.apply([addBody(`body${i}`, sphere(1))]);
  };
  const limit = await thrown(LimitExceeded, adding());
  assert.equal(limit.limit, "max_client_items_per_second");
  assert.ok(limit.retryAfterMs !== undefined && limit.retryAfterMs > 0);
});

test("a daemon that is not there is unavailable", async (t) => {
  await thrown(Unavailable, client(t, "127.0.0.1:1").serverInfo());
});
