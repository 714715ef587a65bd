/** A connection to a daemon. */

import { createClient, type Client as Stub, type Transport } from "@connectrpc/connect";
import { sha256 } from "@noble/hashes/sha2.js";
import { bytesToHex } from "@noble/hashes/utils.js";

import { translating } from "./errors.js";
import { callOf, type Call } from "./question.js";
import { Robot, type RobotDescription } from "./robots.js";
import { Scene } from "./scene.js";
import * as v1 from "./v1.js";

/** Bytes of a file in one message of an upload. */
const CHUNK = 1 << 20;

/** A daemon, as `connect` of `clearance/node` or `clearance/web` makes it. */
export class Client {
  /** The generated stubs, for everything that has no method here. They throw the same errors. */
  readonly scenes: Stub<typeof v1.Scenes>;
  readonly assets: Stub<typeof v1.Assets>;
  readonly robots: Stub<typeof v1.Robots>;
  readonly queries: Stub<typeof v1.Queries>;
  readonly server: Stub<typeof v1.Server>;
  /** What the stubs call through. */
  readonly transport: Transport;

  /** Any transport of Connect does; `close` ends what is behind it. */
  constructor(
    transport: Transport,
    readonly close: () => void = () => {},
  ) {
    this.transport = translating(transport);
    this.scenes = createClient(v1.Scenes, this.transport);
    this.assets = createClient(v1.Assets, this.transport);
    this.robots = createClient(v1.Robots, this.transport);
    this.queries = createClient(v1.Queries, this.transport);
    this.server = createClient(v1.Server, this.transport);
  }

  /** Version, doors, limits, scenes and their epochs. */
  async serverInfo(call: Call = {}): Promise<v1.GetServerInfoResponse> {
    return await this.server.getServerInfo({}, callOf(call));
  }

  /** A new, empty scene. */
  async createScene(name: string, call: Call = {}): Promise<Scene> {
    await this.scenes.createScene({ name }, callOf(call));
    return this.scene(name);
  }

  /** A scene that is there already. Whether it is shows with the first call. */
  scene(name: string): Scene {
    return new Scene(this, name);
  }

  /** All scenes, in the order of their names. */
  async listScenes(call: Call = {}): Promise<v1.SceneSummary[]> {
    return (await this.scenes.listScenes({}, callOf(call))).scenes;
  }

  /** Uploads the meshes that the daemon does not have, and loads the robot. */
  async loadRobot(description: RobotDescription, call: Call = {}): Promise<Robot> {
    const meshes = [...(description.meshes ?? new Map<string, Uint8Array>())];
    const hashes = await this.upload(
      meshes.map(([, file]) => file),
      call,
    );
    const { robot } = await this.robots.loadRobot(
      {
        urdf: description.urdf,
        ...(description.srdf !== undefined && { srdf: description.srdf }),
        meshes: meshes.map(([filename], i) => ({ filename, sha256: hashes[i] as string })),
        meshMode: description.meshMode ?? v1.MeshMode.HULL,
        padding: description.padding ?? 0,
        scale: description.scale ?? 1,
      },
      callOf(call),
    );
    if (robot === undefined) throw new TypeError("the daemon's answer has no robot");
    return new Robot(robot);
  }

  /** Uploads files that the daemon does not have yet; returns the SHA-256 of each, by which messages name them. */
  async upload(files: readonly Uint8Array[], call: Call = {}): Promise<string[]> {
    if (files.length === 0) return [];
    const hashes = files.map((file) => bytesToHex(sha256(file)));
    const { present } = await this.assets.hasAssets({ sha256: hashes }, callOf(call));
    const here = new Set(hashes.filter((_, i) => present[i]));
    for (const [i, file] of files.entries()) {
      const hash = hashes[i] as string;
      if (here.has(hash)) continue;
      await this.assets.putAsset(parts(hash, file), callOf(call));
      here.add(hash);
    }
    return hashes;
  }
}

async function* parts(hash: string, file: Uint8Array) {
  yield { part: { case: "header" as const, value: { sha256: hash, bytes: BigInt(file.length) } } };
  for (let start = 0; start < file.length; start += CHUNK) {
    yield { part: { case: "chunk" as const, value: file.subarray(start, start + CHUNK) } };
  }
}
