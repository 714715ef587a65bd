/** A daemon of its own for a test, until the test is over. */

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import type { TestContext } from "node:test";

import type { Client } from "clearance";
import { connect, type Options } from "clearance/node";

export const ROOT = process.env["CLEARANCE_ROOT"] ?? "../..";
export const UR5 = join(ROOT, "tests/data/robot-ur5");
const PROGRAM = process.env["CLEARANCE_BIN"] ?? join(ROOT, "target/debug/clearance");

/** A folder that is gone after the test. */
export async function folder(t: TestContext): Promise<string> {
  const path = await mkdtemp(join(tmpdir(), "clearance-"));
  t.after(() => rm(path, { recursive: true }));
  return path;
}

/** Starts a daemon and tells where it listens. */
export async function daemon(t: TestContext, configuration = "", address = "127.0.0.1:0"): Promise<string> {
  const file = join(await folder(t), "clearance.toml");
  await writeFile(file, configuration);
  const started = spawn(PROGRAM, ["serve", "--config", file, "--grpc-address", address, "--no-shared-memory", "--no-zenoh"], { stdio: ["ignore", "pipe", "ignore"] });
  const watchdog = setTimeout(() => started.kill("SIGKILL"), 120_000);
  t.after(async () => {
    const ended = once(started, "exit");
    started.kill("SIGTERM");
    const [code] = (await ended) as [number | null];
    clearTimeout(watchdog);
    if (code !== 0) throw new Error(`the daemon ended with ${code}`);
  });
  const [line] = (await once(createInterface(started.stdout), "line")) as [string];
  const [listening, door, where] = line.split(" ");
  if (listening !== "listening" || door !== "grpc" || where === undefined) throw new Error(`${PROGRAM} said ${line}`);
  return where;
}

/** A client that is closed after the test. */
export function client(t: TestContext, address: string, options: Options = {}): Client {
  const made = connect(address, { timeoutMs: 30_000, ...options });
  t.after(() => made.close());
  return made;
}

/** What a promise is rejected with, which has to be a `Kind`. */
export async function thrown<E extends Error>(Kind: abstract new (...of: never[]) => E, promise: Promise<unknown>): Promise<E> {
  try {
    await promise;
  } catch (error) {
    if (error instanceof Kind) return error;
    throw error;
  }
  throw new Error(`no ${Kind.name} was thrown`);
}
