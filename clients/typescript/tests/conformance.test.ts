import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import test from "node:test";

import { site } from "./browser.js";
import { conform } from "./conformance.js";
import { client, daemon, ROOT } from "./daemon.js";

function complete({ seen, different }: Awaited<ReturnType<typeof conform>>): void {
  assert.deepEqual(Object.keys(seen).sort(), ["ask", "asset", "refuse", "stream"]);
  assert.deepEqual(different, []);
}

test("the recorded answers are brought from Node", async (t) => {
  const records = await readFile(join(ROOT, "tests/data/conformance/records.txt"), "utf8");
  complete(await conform(client(t, await daemon(t)), records, (path) => readFile(join(ROOT, path))));
});

test("the recorded answers are brought from a browser", async (t) => {
  const pages = await site(t);
  const address = await daemon(t, `[grpc.web]\nallowed_origins = ["${pages.origin}"]\n`);
  const report = await pages.visit(`conformance.html?daemon=http://${address}`);
  assert.equal(report.state, "done", report.text);
  complete(JSON.parse(report.text) as Awaited<ReturnType<typeof conform>>);
});
