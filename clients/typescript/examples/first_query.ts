/**
 * The first query from Node, over gRPC.
 *
 *     clearance serve &
 *     node first_query.js [ADDRESS [FOLDER]]
 *
 * FOLDER holds a robot's `ur5.urdf`, `ur5.srdf` and meshes.
 */

import { join } from "node:path";

import { connect, DEFAULT_ADDRESS, readRobot } from "clearance/node";

import { firstQuery } from "./ask.js";

const [address = DEFAULT_ADDRESS, folder = "tests/data/robot-ur5"] = process.argv.slice(2);
const client = connect(address);
try {
  const description = await readRobot(join(folder, "ur5.urdf"), join(folder, "ur5.srdf"));
  await firstQuery(client, description, `first query ${process.pid}`, (line) => console.log(line));
} finally {
  client.close();
}
