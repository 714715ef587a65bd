/** Edits of a scene, for `Scene.apply`, and what a question holds against it. Edits are made in order, all or none. */

import type { MessageInitShape } from "@bufbuild/protobuf";

import { numbers, vec3, type Point, type PoseInit, type ShapeInit } from "./geometry.js";
import type { Robot } from "./robots.js";
import type * as v1 from "./v1.js";

export type EditInit = MessageInitShape<typeof v1.EditSchema>;
export type PartyInit = MessageInitShape<typeof v1.PartySchema>;
export type SubjectInit = MessageInitShape<typeof v1.SubjectSchema>;
type AddBodyInit = MessageInitShape<typeof v1.AddBodySchema>;
type BodyRefInit = MessageInitShape<typeof v1.BodyRefSchema>;

/** A body, by its name or by the id the scene gave it. */
export type BodyName = string | bigint;

export function bodyRef(body: BodyName): BodyRefInit {
  return { by: typeof body === "string" ? { case: "name", value: body } : { case: "id", value: body } };
}

/** A rigid body enters the scene; `more` has groups, layers, mask, padding and scale. */
export function addBody(name: string, shape: ShapeInit, pose: PoseInit = {}, more: Partial<AddBodyInit> = {}): EditInit {
  return { kind: { case: "addBody", value: { ...more, name, shape, pose } as AddBodyInit } };
}

export function moveBody(body: BodyName, pose: PoseInit): EditInit {
  return { kind: { case: "moveBody", value: { body: bodyRef(body), pose } } };
}

export function removeBody(body: BodyName): EditInit {
  return { kind: { case: "removeBody", value: { body: bodyRef(body) } } };
}

export function replaceShape(body: BodyName, shape: ShapeInit): EditInit {
  return { kind: { case: "replaceShape", value: { body: bodyRef(body), shape } } };
}

/** Whether a body takes part. */
export function setEnabled(body: BodyName, enabled: boolean): EditInit {
  return { kind: { case: "setEnabled", value: { body: bodyRef(body), enabled } } };
}

/** A body of voxels gets the cells of these points too; in the body's frame. */
export function insertPoints(body: BodyName, points: readonly Point[]): EditInit {
  return { kind: { case: "insertPoints", value: { body: bodyRef(body), points: numbers(points.flat()) } } };
}

/** A body of voxels loses every cell that a point of the box belongs to; in the body's frame. */
export function clearBox(body: BodyName, least: Point, greatest: Point): EditInit {
  const between = { min: vec3(least), max: vec3(greatest) };
  return { kind: { case: "clearBox", value: { body: bodyRef(body), box: between } } };
}

/** A loaded robot stands in the scene; `base` is the pose of its root link. */
export function addRobot(name: string, robot: Robot, base: PoseInit = {}): EditInit {
  return { kind: { case: "addRobot", value: { name, model: robot.id, base } } };
}

export function moveRobot(robot: string, base: PoseInit): EditInit {
  return { kind: { case: "moveRobot", value: { robot, base } } };
}

export function removeRobot(robot: string): EditInit {
  return { kind: { case: "removeRobot", value: { robot } } };
}

/** True: the pair is not looked at. False: it is, whatever less specific entries say. Undefined: no entry any more. */
export function allowCollision(a: PartyInit, b: PartyInit, allowed: boolean | undefined = true): EditInit {
  const value = allowed === undefined ? { a, b } : { a, b, allowed };
  return { kind: { case: "setAllowedCollision", value } };
}

/** The margin of this pair in metres, in place of the question's. Undefined: no entry any more. */
export function setPairMargin(a: PartyInit, b: PartyInit, margin: number | undefined): EditInit {
  return { kind: { case: "setPairMargin", value: margin === undefined ? { a, b } : { a, b, margin } } };
}

/**
 * What may be asked of this pair; with each effect goes what it needs. Of none the pair is not looked at, and answers list it in
 * their coverage. Undefined: nothing is declared any more.
 */
export function declareEffects(a: PartyInit, b: PartyInit, effects: v1.Effect[] | undefined): EditInit {
  return { kind: { case: "declareEffects", value: effects === undefined ? { a, b } : { a, b, effects: { effects } } } };
}

/** Sides of an entry for pairs. */
export function oneBody(body: BodyName): PartyInit {
  return { kind: { case: "body", value: bodyRef(body) } };
}

export function oneLink(robot: string, link: string): PartyInit {
  return { kind: { case: "link", value: { robot, link } } };
}

export function group(name: string): PartyInit {
  return { kind: { case: "group", value: name } };
}

export function allLinks(robot: string): PartyInit {
  return { kind: { case: "robot", value: robot } };
}

export function everything(): PartyInit {
  return { kind: { case: "everything", value: {} } };
}

/** What is held against a scene: one body, or a shape at a pose. */
export type Asked = BodyName | { shape: ShapeInit; pose?: PoseInit } | SubjectInit;

/** Every pair of bodies that changed after a revision. */
export function changedSince(revision: bigint): SubjectInit {
  return { kind: { case: "changedSince", value: { revision } } };
}

export function subject(asked: Asked): SubjectInit {
  if (typeof asked === "string" || typeof asked === "bigint") return { kind: { case: "body", value: bodyRef(asked) } };
  if ("shape" in asked) return { kind: { case: "shape", value: asked } };
  return asked as SubjectInit;
}
