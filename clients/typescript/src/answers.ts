/** Answers of batches as arrays. Metres. */

import { numbersOf } from "./geometry.js";
import * as v1 from "./v1.js";

/** What a bracket decides. */
export type Verdict = "FREE" | "MARGIN" | "COLLISION" | "INDETERMINATE" | "NOT_RUN" | "INVALID_INPUT";

/** The verdict of a message as text. */
export function verdictOf(verdict: v1.Verdict): Verdict {
  return v1.Verdict[verdict] as Verdict;
}

/** Brackets of all items of a batch; NaN where an item has no such pair, empty where none was wanted. */
export interface Brackets {
  /** The signed distance is, in the truth, between these; negative is depth. */
  readonly lower: Float64Array;
  readonly upper: Float64Array;
  /** The best estimate inside. */
  readonly signedDistance: Float64Array;
}

interface Batch {
  /** The state of the scene that was asked. */
  readonly epoch: bigint;
  readonly revision: bigint;
  readonly verdicts: readonly Verdict[];
  /** Of items that are INVALID_INPUT: which field, and what is wrong with it. */
  readonly problems: ReadonlyMap<number, string>;
  /** With `stopAtFirst`, and of paths: the item that stopped the batch. */
  readonly stoppedAt: number | undefined;
  /** Time ran out; items not looked at are NOT_RUN. */
  readonly outOfTime: boolean;
  readonly cost: v1.Cost | undefined;
}

/** The answer to a batch of a robot's states, one element a state. */
export interface States extends Batch {
  /** Of the nearest pair at all, of two links, of a link and a body. */
  readonly nearest: Brackets;
  readonly nearestSelf: Brackets;
  readonly nearestScene: Brackets;
}

/**
 * The answer to a batch of motions, one element a motion. Times are fractions of a motion: 0 at its start, 1 at its goal; NaN
 * where a motion has no such time.
 */
export interface Motions extends Batch {
  /** Every state before this is proved farther than the margins. */
  readonly freeUntil: Float64Array;
  /**
   * Of collisions: all before `reachedFrom` is proved apart, and the state at `reachedTo` collides. Of MARGIN the same for coming
   * within a margin.
   */
  readonly reachedFrom: Float64Array;
  readonly reachedTo: Float64Array;
  /** Of INDETERMINATE: the first stretch that nothing decides. */
  readonly undecidedFrom: Float64Array;
  readonly undecidedTo: Float64Array;
  /** States that each motion was looked at in, count. */
  readonly states: Float64Array;
}

export function statesOf(answer: v1.Answer, asked: number): States {
  const { bulk } = answer;
  return {
    ...batchOf("states", answer, asked),
    nearest: bracketsOf(bulk?.nearest),
    nearestSelf: bracketsOf(bulk?.nearestSelf),
    nearestScene: bracketsOf(bulk?.nearestScene),
  };
}

export function motionsOf(answer: v1.Answer, bulk: v1.BulkMotions | undefined, asked: number): Motions {
  return {
    ...batchOf("motions", answer, asked),
    freeUntil: numbersOf(bulk?.freeUntil),
    reachedFrom: numbersOf(bulk?.reachedFrom),
    reachedTo: numbersOf(bulk?.reachedTo),
    undecidedFrom: numbersOf(bulk?.undecidedFrom),
    undecidedTo: numbersOf(bulk?.undecidedTo),
    states: numbersOf(bulk?.states),
  };
}

/** The daemon sees one list of numbers and cuts it by the robot's joints, whatever the rows were. */
export function checkCount(what: string, asked: number, answered: number): void {
  if (asked === answered) return;
  const why = "they do not have as many numbers as the robot takes";
  throw new RangeError(`${what}: ${asked} were asked and ${answered} answered: ${why}`);
}

function batchOf(what: string, answer: v1.Answer, asked: number): Batch {
  const verdicts = Array.from(answer.bulk?.verdicts ?? [], (number) => verdictOf(number));
  checkCount(what, asked, verdicts.length);
  return {
    epoch: answer.epoch,
    revision: answer.revision,
    verdicts,
    problems: new Map(answer.bulk?.problems.map((each) => [each.item, each.problem])),
    stoppedAt: answer.stoppedAt,
    outOfTime: answer.outOfTime,
    cost: answer.cost,
  };
}

function bracketsOf(bulk: v1.BulkBrackets | undefined): Brackets {
  return {
    lower: numbersOf(bulk?.lower),
    upper: numbersOf(bulk?.upper),
    signedDistance: numbersOf(bulk?.signedDistance),
  };
}
