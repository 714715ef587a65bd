/** The first query from a page, over gRPC-Web: `index.html?daemon=http://127.0.0.1:50551&robot=URL-OF-A-FOLDER/`. */

import { connect, fetchRobot } from "clearance/web";

import { firstQuery } from "../ask.js";

const asked = new URLSearchParams(location.search);
const text = document.getElementById("text") as HTMLPreElement;
try {
  const client = connect(asked.get("daemon") ?? "http://127.0.0.1:50551");
  const folder = asked.get("robot") ?? "robot-ur5/";
  const description = await fetchRobot(`${folder}ur5.urdf`, `${folder}ur5.srdf`);
  await firstQuery(client, description, `first query ${crypto.getRandomValues(new Uint32Array(1))[0]}`, (line) => text.append(`${line}\n`));
  document.body.dataset["state"] = "done";
} catch (error) {
  text.append(`${String(error)}\n`);
  document.body.dataset["state"] = "failed";
}
