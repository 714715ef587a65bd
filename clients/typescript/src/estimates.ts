/** What would a question cost? Which prices are asked for; `Scene.estimateStates` and its like ask. */

import type { MessageInitShape } from "@bufbuild/protobuf";

import type * as v1 from "./v1.js";

/** What an estimate measures. Empty: every output that the question has, at the daemon's ladder of tolerances. */
export interface Prices {
  /** How wide a bracket may be, metres; 0: as narrow as rounding lets it be. Of motions the resolution, too, and positive. */
  tolerances?: readonly number[];
  /** What to compute, one at a time. */
  outputs?: readonly v1.Output[];
  /** Items to measure at most; absent or beyond the daemon's cap: as many as that is. */
  sample?: number;
  /** Seconds to measure at most; absent or beyond the daemon's cap: as long as that is. */
  time?: number;
}

type EstimateInit = MessageInitShape<typeof v1.EstimateRequestSchema>;

/** The question whose price is asked for. */
export type Priced = NonNullable<Exclude<EstimateInit, v1.EstimateRequest>["question"]>;

export function estimateRequest(question: Priced, { tolerances = [], outputs = [], sample, time }: Prices): EstimateInit {
  return {
    question,
    tolerances: [...tolerances],
    outputs: [...outputs],
    ...(sample !== undefined && { sample }),
    ...(time !== undefined && { time }),
  };
}
