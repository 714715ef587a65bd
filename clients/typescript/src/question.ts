/** How a question is to be answered. */

import type { CallOptions } from "@connectrpc/connect";
import type { MessageInitShape } from "@bufbuild/protobuf";

import { bodyRef, type BodyName } from "./edits.js";
import * as v1 from "./v1.js";

type ContextInit = MessageInitShape<typeof v1.ContextSchema>;

/**
 * What an answer has beside its verdicts: nothing, and the quickest; brackets of the nearest pairs; tight ones of pairs that
 * overlap as well; points and normals as well; where faces touch as well.
 */
export type Want = "verdict" | "distance" | "depth" | "witness" | "patch";

/** How long a call may take, and what stops it. */
export type Call = Pick<CallOptions, "timeoutMs" | "signal">;

export interface Question extends Call {
  /** In place of what the method would want. */
  want?: Want;
  /** How pairs that have points and normals change when their bodies move, as well; `{}`: exact. */
  derivatives?: MessageInitShape<typeof v1.DerivativeOptionsSchema>;
  /** Metres: a pair apart but nearer than this is MARGIN. */
  margin?: number;
  /** Metres: pairs farther than this need no distance. */
  cutOff?: number;
  /** Waits for a revision until the deadline. */
  atLeast?: bigint;
  exactly?: bigint;
  /** Items after the first hit are left NOT_RUN; `stoppedAt` of the answer names it. */
  stopAtFirst?: boolean;
  /** Seconds that the daemon may look; items not looked at by then are NOT_RUN. */
  timeBudget?: number;
  /** Pairs listed for an item at most. */
  maxPairs?: number;
  /** Bodies to be left out. */
  ignore?: readonly BodyName[];
  /** Edits that only this question sees. */
  whatIf?: MessageInitShape<typeof v1.OverlaySchema>;
  /** How far motions are followed. */
  effort?: MessageInitShape<typeof v1.MotionEffortSchema>;
  /** Whatever no word above sets. */
  context?: Partial<ContextInit>;
}

/** The context of a request. */
export function contextOf(scene: string, question: Question, byDefault: Want, more: Partial<ContextInit> = {}): ContextInit {
  const want = question.want ?? byDefault;
  const points = want === "witness" || want === "patch";
  const context: Record<string, unknown> = {
    ...question.context,
    ...more,
    scene,
    wants: {
      distance: want !== "verdict",
      depth: want === "depth" || points,
      witness: points,
      patch: want === "patch",
      derivatives: question.derivatives !== undefined,
      ...more.wants,
    },
    derivatives: question.derivatives,
    margin: question.margin,
    cutOff: question.cutOff,
    timeBudget: question.timeBudget,
    maxPairs: question.maxPairs,
    overlay: question.whatIf,
    ...(question.ignore && { filter: { ...question.context?.filter, ignore: question.ignore.map(bodyRef) } }),
    ...(question.atLeast !== undefined && { revision: { rule: { case: "atLeast", value: question.atLeast } } }),
    ...(question.exactly !== undefined && { revision: { rule: { case: "exactly", value: question.exactly } } }),
  };
  for (const key of Object.keys(context)) if (context[key] === undefined) delete context[key];
  return context as ContextInit;
}

export function modeOf(question: Question): v1.Mode {
  return question.stopAtFirst === true ? v1.Mode.STOP_AT_FIRST : v1.Mode.UNSPECIFIED;
}

/** What of a question concerns the call. */
export function callOf({ timeoutMs, signal }: Call): CallOptions {
  return { ...(timeoutMs !== undefined && { timeoutMs }), ...(signal !== undefined && { signal }) };
}
