/** The examples and the README do what they say, from Node and in a browser; the generated code is that of the .proto files. */

import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readdir, readFile } from "node:fs/promises";
import { join } from "node:path";
import test, { type TestContext } from "node:test";
import { promisify } from "node:util";

import { site } from "./browser.js";
import { daemon, folder, ROOT, UR5 } from "./daemon.js";

const run = promisify(execFile);
const expected = readFile(join(ROOT, "tests/data/first_query.txt"), "utf8");

test("the first query from Node prints what that of every client prints", async (t) => {
  const program = join(process.env["CLEARANCE_PROGRAMS"] as string, "first_query.js");
  const { stdout } = await run(process.execPath, [program, await daemon(t), UR5], { timeout: 60_000 });
  assert.equal(stdout, await expected);
});

async function visit(t: TestContext, allowed: (origin: string) => string) {
  const pages = await site(t);
  const address = await daemon(t, `[grpc.web]\nallowed_origins = ["${allowed(pages.origin)}"]\n`);
  return await pages.visit(`index.html?daemon=http://${address}&robot=/data/robot-ur5/`);
}

test("the first query from a page prints the same", async (t) => {
  assert.deepEqual(await visit(t, (origin) => origin), { state: "done", text: await expected });
});

test("a page of an origin that is not allowed is told nothing", async (t) => {
  const report = await visit(t, () => "http://elsewhere.example");
  assert.equal(report.state, "failed");
  assert.match(report.text, /^Unavailable: UNAVAILABLE: /);
});

test("the program in the README runs", async (t) => {
  const program = join(process.env["CLEARANCE_PROGRAMS"] as string, "readme.js");
  const env = { ...process.env, CLEARANCE_ADDRESS: await daemon(t) };
  const { stdout } = await run(process.execPath, [program], { timeout: 60_000, cwd: UR5, env });
  assert.match(stdout, /COLLISION/);
  assert.match(stdout, /INVALID_FIELD 0 edits\[0\]/);
});

test("generating again changes nothing", async (t) => {
  const fresh = await folder(t);
  const package_ = join(ROOT, "clients/typescript");
  await run(join(package_, "regenerate"), [fresh], { timeout: 60_000 });
  const kept = join(package_, "src/v1");
  const names = await readdir(fresh);
  assert.ok(names.length > 0);
  assert.deepEqual(names.sort(), (await readdir(kept)).sort());
  for (const name of names) {
    const same = (await readFile(join(fresh, name))).equals(await readFile(join(kept, name)));
    assert.ok(same, `${name}: run clients/typescript/regenerate`);
  }
});
