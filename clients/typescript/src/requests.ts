/** Requests of questions, as they are asked and as their prices are. */

import type { MessageInitShape } from "@bufbuild/protobuf";

import { subject, type Asked } from "./edits.js";
import { bytesOf } from "./geometry.js";
import { contextOf, modeOf, type Question } from "./question.js";
import * as v1 from "./v1.js";

/** Vectors of joint positions: radians, metres for sliding joints. */
export type Rows = readonly ArrayLike<number>[];

export function checkStates(scene: string, robot: string, states: Rows, question: Question) {
  return {
    context: contextOf(scene, question, "distance", { answerForm: v1.AnswerForm.BULK }),
    robot,
    positions: table("states", states),
    mode: modeOf(question),
  } satisfies MessageInitShape<typeof v1.CheckStatesRequestSchema>;
}

export function lookAtStates(scene: string, robot: string, states: Rows, question: Question) {
  const context = contextOf(scene, question, "witness");
  context.wants = { ...context.wants, pairs: true } as v1.Wants;
  return {
    context,
    robot,
    positions: table("states", states),
    mode: modeOf(question),
  } satisfies MessageInitShape<typeof v1.CheckStatesRequestSchema>;
}

export function checkMotions(scene: string, robot: string, starts: Rows, goals: Rows, question: Question) {
  if (starts.length !== goals.length) throw new RangeError(`goals: are ${goals.length}, starts are ${starts.length}`);
  return {
    context: contextOf(scene, question, "verdict", { answerForm: v1.AnswerForm.BULK }),
    robot,
    positions: table("starts and goals", starts.flatMap((start, i) => [start, goals[i] as ArrayLike<number>])),
    mode: modeOf(question),
    effort: question.effort ?? {},
  } satisfies MessageInitShape<typeof v1.CheckMotionsRequestSchema>;
}

export function checkPath(scene: string, robot: string, waypoints: Rows, question: Question) {
  return {
    context: contextOf(scene, question, "verdict", { answerForm: v1.AnswerForm.BULK }),
    robot,
    waypoints: table("waypoints", waypoints),
    mode: modeOf(question),
    effort: question.effort ?? {},
  } satisfies MessageInitShape<typeof v1.CheckPathRequestSchema>;
}

export function distance(scene: string, subjects: readonly Asked[], question: Question) {
  const context = contextOf(scene, question, "witness");
  return { context, items: items(subjects), mode: modeOf(question) } satisfies MessageInitShape<typeof v1.DistanceRequestSchema>;
}

export function collide(scene: string, subjects: readonly Asked[], question: Question) {
  const context = contextOf(scene, question, "verdict");
  return { context, items: items(subjects), mode: modeOf(question) } satisfies MessageInitShape<typeof v1.CollideRequestSchema>;
}

export function clearance(scene: string, within: number, subjects: readonly Asked[], question: Question) {
  return {
    context: contextOf(scene, question, "distance"),
    within,
    mode: modeOf(question),
    subjects: { case: "items", value: { items: items(subjects) } },
  } satisfies MessageInitShape<typeof v1.ClearanceRequestSchema>;
}

export function clearanceOfStates(scene: string, robot: string, states: Rows, within: number, question: Question) {
  return {
    context: contextOf(scene, question, "distance"),
    within,
    mode: modeOf(question),
    subjects: { case: "states", value: { robot, positions: table("states", states) } },
  } satisfies MessageInitShape<typeof v1.ClearanceRequestSchema>;
}

function items(subjects: readonly Asked[]) {
  return subjects.length > 0 ? subjects.map(subject) : [{ kind: { case: "allPairs" as const, value: {} } }];
}

function table(name: string, rows: Rows) {
  const width = rows[0]?.length ?? 0;
  const numbers = new Float64Array(width * rows.length);
  for (const [i, row] of rows.entries()) {
    if (row.length !== width) throw new RangeError(`${name}[${i}]: has ${row.length} numbers, the first has ${width}`);
    numbers.set(row, i * width);
  }
  return { form: { case: "littleEndian" as const, value: bytesOf(numbers) } };
}
