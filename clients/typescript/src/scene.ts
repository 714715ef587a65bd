/** A scene of a daemon, and the questions it answers. */

import { checkCount, motionsOf, statesOf, type Motions, type States } from "./answers.js";
import type { Client } from "./client.js";
import type { Asked, EditInit } from "./edits.js";
import { estimateRequest, type Priced, type Prices } from "./estimates.js";
import { callOf, contextOf, type Call, type Question } from "./question.js";
import * as requests from "./requests.js";
import type { Rows } from "./requests.js";
import * as v1 from "./v1.js";

export type { Rows } from "./requests.js";

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
    const request = requests.checkStates(this.name, robot, states, question);
    const { answer } = await this.client.queries.checkStates(request, callOf(question));
    return statesOf(there(answer), states.length);
  }

  /**
   * As `checkStates`, with everything there is to know: which pairs, and where. For a few states; a batch of thousands is quicker
   * without.
   */
  async lookAtStates(robot: string, states: Rows, question: Question = {}): Promise<v1.Answer> {
    const request = requests.lookAtStates(this.name, robot, states, question);
    const { answer } = await this.client.queries.checkStates(request, callOf(question));
    checkCount("states", states.length, there(answer).items.length);
    return there(answer);
  }

  /**
   * Is the robot free all along straight lines of joint positions, from each start to its goal? Proved between states, not
   * sampled.
   */
  async checkMotions(robot: string, starts: Rows, goals: Rows, question: Question = {}): Promise<Motions> {
    const request = requests.checkMotions(this.name, robot, starts, goals, question);
    const response = await this.client.queries.checkMotions(request, callOf(question));
    return motionsOf(there(response.answer), response.bulk, starts.length);
  }

  /** Is the robot free all along a path, and where is it blocked first? `stoppedAt` of the answer. */
  async checkPath(robot: string, waypoints: Rows, question: Question = {}): Promise<Motions> {
    const request = requests.checkPath(this.name, robot, waypoints, question);
    const response = await this.client.queries.checkPath(request, callOf(question));
    return motionsOf(there(response.answer), response.bulk, Math.max(waypoints.length - 1, 0));
  }

  /**
   * How far is the nearest body from each subject? Without subjects: the nearest pair of all bodies. Tells points and normals unless
   * the question wants something else.
   */
  async distance(subjects: readonly Asked[] = [], question: Question = {}): Promise<v1.Answer> {
    const request = requests.distance(this.name, subjects, question);
    return there((await this.client.queries.distance(request, callOf(question))).answer);
  }

  /** Which bodies does each subject touch? Without subjects: which pairs of all bodies touch. */
  async collide(subjects: readonly Asked[] = [], question: Question = {}): Promise<v1.Answer> {
    const request = requests.collide(this.name, subjects, question);
    return there((await this.client.queries.collide(request, callOf(question))).answer);
  }

  /** Which bodies are within that many metres of each subject? `pairs` of each item. */
  async clearance(within: number, subjects: readonly Asked[] = [], question: Question = {}): Promise<v1.Answer> {
    const request = requests.clearance(this.name, within, subjects, question);
    return there((await this.client.queries.clearance(request, callOf(question))).answer);
  }

  /** Which pairs of links, and of links and bodies, are within that many metres in each state? */
  async clearanceOfStates(robot: string, states: Rows, within: number, question: Question = {}): Promise<v1.Answer> {
    const request = requests.clearanceOfStates(this.name, robot, states, within, question);
    const { answer } = await this.client.queries.clearance(request, callOf(question));
    checkCount("states", states.length, there(answer).items.length);
    return there(answer);
  }

  /**
   * What would `checkStates` cost, and the others below? One row for each output and tolerance: a sample of the items is asked, and
   * timed. What the question wants, its accuracy and `stopAtFirst` do not count, as each row has its own.
   */
  async estimateStates(robot: string, states: Rows, prices: Prices = {}, question: Question = {}): Promise<v1.EstimateResponse> {
    const value = requests.checkStates(this.name, robot, states, question);
    const told = await this.estimate({ case: "checkStates", value }, prices, question);
    checkCount("states", states.length, Number(told.items));
    return told;
  }

  async estimateMotions(robot: string, starts: Rows, goals: Rows, prices: Prices = {}, question: Question = {}): Promise<v1.EstimateResponse> {
    const value = requests.checkMotions(this.name, robot, starts, goals, question);
    const told = await this.estimate({ case: "checkMotions", value }, prices, question);
    checkCount("motions", starts.length, Number(told.items));
    return told;
  }

  async estimatePath(robot: string, waypoints: Rows, prices: Prices = {}, question: Question = {}): Promise<v1.EstimateResponse> {
    const value = requests.checkPath(this.name, robot, waypoints, question);
    const told = await this.estimate({ case: "checkPath", value }, prices, question);
    checkCount("motions", Math.max(waypoints.length - 1, 0), Number(told.items));
    return told;
  }

  /** Without subjects: all pairs, as one item. */
  async estimateDistance(subjects: readonly Asked[] = [], prices: Prices = {}, question: Question = {}): Promise<v1.EstimateResponse> {
    const value = requests.distance(this.name, subjects, question);
    return await this.estimate({ case: "distance", value }, prices, question);
  }

  async estimateCollide(subjects: readonly Asked[] = [], prices: Prices = {}, question: Question = {}): Promise<v1.EstimateResponse> {
    const value = requests.collide(this.name, subjects, question);
    return await this.estimate({ case: "collide", value }, prices, question);
  }

  async estimateClearance(
    within: number,
    subjects: readonly Asked[] = [],
    prices: Prices = {},
    question: Question = {},
  ): Promise<v1.EstimateResponse> {
    const value = requests.clearance(this.name, within, subjects, question);
    return await this.estimate({ case: "clearance", value }, prices, question);
  }

  /** What the question says, for requests of the stubs. */
  context(question: Question = {}): ReturnType<typeof contextOf> {
    return contextOf(this.name, question, "verdict");
  }

  private async estimate(of: Priced, prices: Prices, question: Question): Promise<v1.EstimateResponse> {
    return await this.client.queries.estimate(estimateRequest(of, prices), callOf(question));
  }
}

function there(answer: v1.Answer | undefined): v1.Answer {
  if (answer === undefined) throw new TypeError("the daemon's reply has no answer");
  return answer;
}
