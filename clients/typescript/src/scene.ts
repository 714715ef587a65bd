/** A scene of a daemon, and the questions it answers. */

import { checkCount, motionsOf, statesOf, type Motions, type States } from "./answers.js";
import type { Client } from "./client.js";
import { subject, type Asked, type EditInit } from "./edits.js";
import { bytesOf } from "./geometry.js";
import { callOf, contextOf, modeOf, type Call, type Question } from "./question.js";
import * as v1 from "./v1.js";

/** Vectors of joint positions: radians, metres for sliding joints. */
export type Rows = readonly ArrayLike<number>[];

/** What `Scene.apply` may be held to. */
export interface Expected extends Call {
  /** Edits are made only if the scene is at that revision; else `Conflict`. */
  expectedRevision?: bigint;
  /** And in that epoch. */
  expectedEpoch?: bigint;
  /** The same key and edits again are answered as the first time. */
  idempotencyKey?: string;
}

/** A scene, by its name. Made by `Client.createScene` and `Client.scene`. */
export class Scene {
  constructor(
    private readonly client: Client,
    readonly name: string,
  ) {}

  /** Makes all edits, in order, or none. The answer names the revision that contains them, and the ids of added bodies. */
  async apply(edits: readonly EditInit[], expected: Expected = {}): Promise<v1.ApplyResponse> {
    const { timeoutMs, signal, ...rest } = expected;
    const call = callOf({ ...(timeoutMs !== undefined && { timeoutMs }), ...(signal !== undefined && { signal }) });
    return await this.client.scenes.apply({ ...rest, scene: this.name, edits: [...edits] }, call);
  }

  /** Bodies and robots of the newest revision; of a large scene page by page, as one. */
  async contents(call: Call = {}): Promise<v1.SceneContents> {
    const of = async (request: Partial<v1.GetSceneRequest>) => {
      const { scene } = await this.client.scenes.getScene({ ...request, scene: this.name } as v1.GetSceneRequest, callOf(call));
      if (scene === undefined) throw new TypeError("the daemon's answer has no scene");
      return scene;
    };
    const contents = await of({});
    // The other pages are of the first one's state.
    const { epoch, revision: value } = contents;
    const revision = { epoch, rule: { case: "exactly", value } } as v1.RevisionRule;
    for (let last = contents.bodies.at(-1); contents.bodiesLeft && last !== undefined; last = contents.bodies.at(-1)) {
      const page = await of({ revision, afterBody: last.id });
      contents.bodies.push(...page.bodies);
      contents.bodiesLeft = page.bodiesLeft;
    }
    return contents;
  }

  /** The scene is gone. */
  async delete(call: Call = {}): Promise<void> {
    await this.client.scenes.deleteScene({ scene: this.name }, callOf(call));
  }

  /** Is the robot free in these states? Measures the nearest pairs unless the question wants something else. */
  async checkStates(robot: string, states: Rows, question: Question = {}): Promise<States> {
    const { answer } = await this.client.queries.checkStates(
      {
        context: contextOf(this.name, question, "distance", { answerForm: v1.AnswerForm.BULK }),
        robot,
        positions: table("states", states),
        mode: modeOf(question),
      },
      callOf(question),
    );
    return statesOf(there(answer), states.length);
  }

  /**
   * As `checkStates`, with everything there is to know: which pairs, and where. For a few states; a batch of thousands is quicker
   * without.
   */
  async lookAtStates(robot: string, states: Rows, question: Question = {}): Promise<v1.Answer> {
    const context = contextOf(this.name, question, "witness");
    context.wants = { ...context.wants, pairs: true } as v1.Wants;
    const { answer } = await this.client.queries.checkStates(
      { context, robot, positions: table("states", states), mode: modeOf(question) },
      callOf(question),
    );
    checkCount("states", states.length, there(answer).items.length);
    return there(answer);
  }

  /**
   * Is the robot free all along straight lines of joint positions, from each start to its goal? Proved between states, not
   * sampled.
   */
  async checkMotions(robot: string, starts: Rows, goals: Rows, question: Question = {}): Promise<Motions> {
    if (starts.length !== goals.length) throw new RangeError(`goals: are ${goals.length}, starts are ${starts.length}`);
    const response = await this.client.queries.checkMotions(
      {
        context: contextOf(this.name, question, "verdict", { answerForm: v1.AnswerForm.BULK }),
        robot,
        positions: table("starts and goals", starts.flatMap((start, i) => [start, goals[i] as ArrayLike<number>])),
        mode: modeOf(question),
        effort: question.effort ?? {},
      },
      callOf(question),
    );
    return motionsOf(there(response.answer), response.bulk, starts.length);
  }

  /** Is the robot free all along a path, and where is it blocked first? `stoppedAt` of the answer. */
  async checkPath(robot: string, waypoints: Rows, question: Question = {}): Promise<Motions> {
    const response = await this.client.queries.checkPath(
      {
        context: contextOf(this.name, question, "verdict", { answerForm: v1.AnswerForm.BULK }),
        robot,
        waypoints: table("waypoints", waypoints),
        mode: modeOf(question),
        effort: question.effort ?? {},
      },
      callOf(question),
    );
    return motionsOf(there(response.answer), response.bulk, Math.max(waypoints.length - 1, 0));
  }

  /**
   * How far is the nearest body from each subject? Without subjects: the nearest pair of all bodies. Tells points and normals unless
   * the question wants something else.
   */
  async distance(subjects: readonly Asked[] = [], question: Question = {}): Promise<v1.Answer> {
    const context = contextOf(this.name, question, "witness");
    const request = { context, items: items(subjects), mode: modeOf(question) };
    return there((await this.client.queries.distance(request, callOf(question))).answer);
  }

  /** Which bodies does each subject touch? Without subjects: which pairs of all bodies touch. */
  async collide(subjects: readonly Asked[] = [], question: Question = {}): Promise<v1.Answer> {
    const context = contextOf(this.name, question, "verdict");
    const request = { context, items: items(subjects), mode: modeOf(question) };
    return there((await this.client.queries.collide(request, callOf(question))).answer);
  }

  /** Which bodies are within that many metres of each subject? `pairs` of each item. */
  async clearance(within: number, subjects: readonly Asked[] = [], question: Question = {}): Promise<v1.Answer> {
    const { answer } = await this.client.queries.clearance(
      {
        context: contextOf(this.name, question, "distance"),
        within,
        mode: modeOf(question),
        subjects: { case: "items", value: { items: items(subjects) } },
      },
      callOf(question),
    );
    return there(answer);
  }

  /** Which pairs of links, and of links and bodies, are within that many metres in each state? */
  async clearanceOfStates(robot: string, states: Rows, within: number, question: Question = {}): Promise<v1.Answer> {
    const { answer } = await this.client.queries.clearance(
      {
        context: contextOf(this.name, question, "distance"),
        within,
        mode: modeOf(question),
        subjects: { case: "states", value: { robot, positions: table("states", states) } },
      },
      callOf(question),
    );
    checkCount("states", states.length, there(answer).items.length);
    return there(answer);
  }

  /** What the question says, for requests of the stubs. */
  context(question: Question = {}): ReturnType<typeof contextOf> {
    return contextOf(this.name, question, "verdict");
  }
}

function there(answer: v1.Answer | undefined): v1.Answer {
  if (answer === undefined) throw new TypeError("the daemon's reply has no answer");
  return answer;
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
