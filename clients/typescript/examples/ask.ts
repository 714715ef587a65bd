/**
 * A robot in a cell: which of its states are free, how near is the nearest, and what does the daemon say of a mistake? The examples
 * of all clients print the same text; `first_query.ts` asks from Node, `page/first_query.ts` from a browser.
 */

import {
  addBody,
  addRobot,
  at,
  box,
  capsule,
  ellipsoid,
  InvalidRequest,
  moveBody,
  pointOf,
  verdictOf,
  type Client,
  type RobotDescription,
  type Scene,
  type Robot,
  type v1,
} from "clearance";

// Joint positions, radians.
const STATES = [
  [-1.6, -0.6, 0.0, -1.57, -1.57, 3.14],
  [-1.2, -0.6, 0.0, -1.57, -1.57, 3.14],
  [0.4, -0.3, 0.2, -1.57, -1.57, 3.14],
];

export type Print = (line: string) => void;

export async function firstQuery(client: Client, description: RobotDescription, name: string, print: Print): Promise<void> {
  const robot = await client.loadRobot(description);
  print(`robot ${robot.name}: ${robot.degreesOfFreedom} numbers a state, ${robot.links.length} links`);
  const scene = await client.createScene(name);
  try {
    await ask(scene, robot, print);
  } finally {
    await scene.delete();
  }
}

async function ask(scene: Scene, robot: Robot, print: Print): Promise<void> {
  let applied = await scene.apply([
    addRobot("arm", robot),
    addBody("table", box([1.0, 1.0, 0.02]), at(0.0, 0.0, 0.7)),
    addBody("post", capsule(0.05, 0.3), at(0.5, 0.3, 1.2)),
    addBody("ball", ellipsoid([0.3, 0.2, 0.1]), at(0.2, 0.8, 1.3, [0.8, 0.2, 0.4, 0.4])),
  ]);
  const names = new Map(["table", "post", "ball"].map((name, i) => [applied.added[i], name]));
  print(`the scene is at revision ${applied.revision}`);

  // A batch of states: verdicts and proved brackets as arrays.
  const states = await scene.checkStates("arm", STATES, { want: "depth", atLeast: applied.revision });
  for (const [i, verdict] of states.verdicts.entries()) {
    const { lower, upper } = states.nearestScene;
    print(`state ${i}: ${verdict}, to the scene ${bracket(lower[i], upper[i])}`);
  }
  print(`${states.verdicts.filter((verdict) => verdict === "FREE").length} are free`);

  // A state with everything there is to know.
  const [state] = (await scene.lookAtStates("arm", STATES.slice(1, 2))).items;
  for (const pair of state?.pairs ?? []) {
    const link = pair.a?.kind.case === "link" ? robot.links[pair.a.kind.value.link] : undefined;
    print(`state 1: ${link} and ${body(pair.b, names)}, ${verdictOf(pair.verdict)}`);
  }

  // Bodies.
  const nearest = (await scene.distance(["ball"])).items[0]?.nearest;
  print(`${body(nearest?.a, names)} and ${body(nearest?.b, names)}: ${bracket(nearest?.bracket?.lower, nearest?.bracket?.upper)}`);
  print(`from ${point(nearest?.witness?.pointOnA)} to ${point(nearest?.witness?.pointOnB)}`);

  // An edit, and a question that sees it.
  applied = await scene.apply([moveBody("ball", at(0.5, 0.3, 1.6))]);
  const [touching] = (await scene.collide(["ball"], { atLeast: applied.revision })).items;
  const pairs = touching?.pairs.map((pair) => `${body(pair.a, names)} and ${body(pair.b, names)}`).join(", ");
  print(`at revision ${applied.revision} ${verdictOf(touching?.verdict ?? 0)}: ${pairs}`);

  try {
    await scene.apply([moveBody("table", at(0.0, 0.0, 0.6)), addBody("flag", box([1.0, -1.0, 0.1]))]);
  } catch (error) {
    if (!(error instanceof InvalidRequest)) throw error;
    print(`refused: ${error.reason}, item ${error.item}, field ${error.field}`);
  }
}

function body(side: v1.Side | undefined, names: Map<bigint | undefined, string>): string | undefined {
  return side?.kind.case === "body" ? names.get(side.kind.value.id) : undefined;
}

/** Enough digits to see both ends; `+ 0` takes the sign off zero. */
function bracket(lower = NaN, upper = NaN): string {
  return `[${(lower + 0).toFixed(17)}, ${(upper + 0).toFixed(17)}] m`;
}

function point(message: v1.Vec3 | undefined): string {
  return `(${pointOf(message).map((x) => (x + 0).toFixed(9)).join(", ")})`;
}
