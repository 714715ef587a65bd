import { connect } from "clearance/web";

import { conform } from "./conformance.js";

const text = document.getElementById("text") as HTMLPreElement;
const get = async (path: string) => await fetch(path.replace(/^tests/, ""));
try {
  const client = connect(new URLSearchParams(location.search).get("daemon") as string);
  const records = await (await get("tests/data/conformance/records.txt")).text();
  const told = await conform(client, records, async (path) => new Uint8Array(await (await get(path)).arrayBuffer()));
  text.append(JSON.stringify(told));
  document.body.dataset["state"] = "done";
} catch (error) {
  text.append(String(error));
  document.body.dataset["state"] = "failed";
}
