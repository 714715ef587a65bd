/** Robots: descriptions, and models in the daemon. */

import { parseXml, XmlElement, type XmlDocument } from "@rgrove/parse-xml";

import * as v1 from "./v1.js";

/** What a robot is loaded from. `readRobot` of `clearance/node` makes one from files, `fetchRobot` of `clearance/web` from URLs. */
export interface RobotDescription {
  urdf: string;
  /** Without one only adjacent links may touch. */
  srdf?: string;
  /** Bytes of mesh files, by the names that the URDF has for them. */
  meshes?: ReadonlyMap<string, Uint8Array>;
  /** What meshes stand for; by default their convex hulls. */
  meshMode?: v1.MeshMode;
  /** Every shape is scaled, then grown by `padding` metres. */
  scale?: number;
  padding?: number;
}

/** A model that the daemon has loaded. It may stand in any number of scenes. */
export class Robot {
  /** Names the model in the daemon. */
  readonly id: string;
  /** As in the URDF. */
  readonly name: string;
  /** How many numbers a vector of joint positions has. */
  readonly degreesOfFreedom: number;
  /** By the indices that answers use. */
  readonly links: readonly string[];
  /** Limits of each number of a vector of joint positions; infinite where there are none. */
  readonly lower: Float64Array;
  readonly upper: Float64Array;

  /** `model`: everything known of it. */
  constructor(readonly model: v1.RobotModel) {
    this.id = model.id;
    this.name = model.name;
    this.degreesOfFreedom = model.degreesOfFreedom;
    this.links = model.links.map((link) => link.name);
    this.lower = new Float64Array(model.degreesOfFreedom).fill(-Infinity);
    this.upper = new Float64Array(model.degreesOfFreedom).fill(Infinity);
    for (const joint of model.joints) {
      this.lower.fill(joint.lower ?? -Infinity, joint.first, joint.first + joint.width);
      this.upper.fill(joint.upper ?? Infinity, joint.first, joint.first + joint.width);
    }
  }
}

/** The mesh files that the collision shapes of a URDF name, each once, sorted. */
export function meshNames(urdf: string): string[] {
  let found: (XmlDocument | XmlElement)[];
  try {
    found = [parseXml(urdf)];
  } catch (error) {
    throw new SyntaxError(`the URDF is not XML: ${error instanceof Error ? error.message : String(error)}`);
  }
  for (const name of ["robot", "link", "collision", "geometry", "mesh"]) {
    found = found.flatMap((parent) => parent.children.filter((child) => child instanceof XmlElement && child.name === name)) as XmlElement[];
  }
  const names = found.map((mesh) => (mesh as XmlElement).attributes["filename"] ?? "");
  return [...new Set(names)].sort();
}

/** Where `package://NAME/rest` is: `rest` in `packages[NAME]`, else in the URDF's own folder; any other name is a path from there. */
export function resolveMesh(name: string, folder: string, packages: Readonly<Record<string, string>>): [folder: string, path: string] {
  const inPackage = /^package:\/\/([^/]*)\/?(.*)$/.exec(name);
  if (inPackage === null) return [folder, name.replace(/^file:\/\//, "")];
  const [, owner = "", rest = ""] = inPackage;
  return [packages[owner] ?? folder, rest];
}
