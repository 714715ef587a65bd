/** Points, poses and shapes, as messages are made from. Metres; sizes may be zero, and touching collides. */

import type { MessageInitShape } from "@bufbuild/protobuf";

import type * as v1 from "./v1.js";

/** x, y, z. */
export type Point = readonly [number, number, number];
export type PoseInit = MessageInitShape<typeof v1.PoseSchema>;
export type ShapeInit = MessageInitShape<typeof v1.ShapeSchema>;
type NumbersInit = MessageInitShape<typeof v1.NumbersSchema>;

export function vec3([x, y, z]: Point): { x: number; y: number; z: number } {
  return { x, y, z };
}

/** A message as a point; the origin where there is none. */
export function pointOf(message: v1.Vec3 | undefined): Point {
  return message === undefined ? [0, 0, 0] : [message.x, message.y, message.z];
}

/** A pose; `rotation` is a quaternion w, x, y, z of any norm but zero, left out: no rotation. */
export function at(x: number, y: number, z: number, rotation?: readonly [number, number, number, number]): PoseInit {
  const translation = { x, y, z };
  if (rotation === undefined) return { translation };
  const [w, i, j, k] = rotation;
  return { translation, rotation: { w, x: i, y: j, z: k } };
}

export function sphere(radius: number): ShapeInit {
  return { core: { case: "sphere", value: { radius } } };
}

/** |x| <= halfExtents[0], and so for y and z. */
export function box(halfExtents: Point): ShapeInit {
  return { core: { case: "box", value: { halfExtents: vec3(halfExtents) } } };
}

/** A ball swept along the axis z; `halfLength` is that of the core segment. */
export function capsule(radius: number, halfLength: number): ShapeInit {
  return { core: { case: "capsule", value: { radius, halfLength } } };
}

/** Axis z, centred. */
export function cylinder(radius: number, halfLength: number): ShapeInit {
  return { core: { case: "cylinder", value: { radius, halfLength } } };
}

/** Axis z: apex at `halfLength`, base disc at `-halfLength`. */
export function cone(radius: number, halfLength: number): ShapeInit {
  return { core: { case: "cone", value: { radius, halfLength } } };
}

/** Semi-axes along x, y, z. */
export function ellipsoid(radii: Point): ShapeInit {
  return { core: { case: "ellipsoid", value: { radii: vec3(radii) } } };
}

/** The convex hull of points. */
export function convex(points: readonly Point[]): ShapeInit {
  return { core: { case: "convex", value: { points: points.map(vec3) } } };
}

/** Triangles as indices of vertices, counter-clockwise from outside; the mode says what they stand for. */
export function mesh(vertices: readonly Point[], triangles: readonly Point[], mode: v1.MeshMode): ShapeInit {
  return { core: { case: "mesh", value: { vertices: vertices.map(vec3), triangles: triangles.flat(), mode } } };
}

/** The union of placed shapes. */
export function compound(parts: readonly { shape: ShapeInit; pose?: PoseInit }[]): ShapeInit {
  return { core: { case: "compound", value: { parts: [...parts] } } };
}

/** The union of balls around points. */
export function pointCloud(points: readonly Point[], radius = 0): ShapeInit {
  return { core: { case: "pointCloud", value: { points: numbers(points.flat()), radius } } };
}

/** The occupied cells of a grid of side `resolution`: those of points. Without points a map that nothing touches yet. */
export function voxels(resolution: number, points: readonly Point[] = []): ShapeInit {
  return { core: { case: "voxels", value: { resolution, points: numbers(points.flat()) } } };
}

/** The solid normal . x <= offset. */
export function halfSpace(normal: Point, offset: number): ShapeInit {
  return { core: { case: "halfSpace", value: { normal: vec3(normal), offset } } };
}

/** The thin, two-sided normal . x = offset. */
export function plane(normal: Point, offset: number): ShapeInit {
  return { core: { case: "plane", value: { normal: vec3(normal), offset } } };
}

/** The shape grown by a ball, rounded at corners and edges. */
export function ballSwept(shape: ShapeInit, radius: number): ShapeInit {
  return { ...shape, sweptRadius: (shape.sweptRadius ?? 0) + radius };
}

/** Numbers as a message, as bytes. */
export function numbers(values: ArrayLike<number>): NumbersInit {
  return { form: { case: "littleEndian", value: bytesOf(values) } };
}

/** 8 bytes a number, little-endian. */
export function bytesOf(values: ArrayLike<number>): Uint8Array<ArrayBuffer> {
  const view = new DataView(new ArrayBuffer(8 * values.length));
  for (let i = 0; i < values.length; i += 1) view.setFloat64(8 * i, values[i] as number, true);
  return new Uint8Array(view.buffer);
}

/** The numbers of a bulk answer; none of an empty field. */
export function numbersOf(bytes: Uint8Array | undefined): Float64Array {
  if (bytes === undefined) return new Float64Array();
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return Float64Array.from({ length: bytes.byteLength / 8 }, (_, i) => view.getFloat64(8 * i, true));
}
