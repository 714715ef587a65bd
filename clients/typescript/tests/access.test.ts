/** What a client shows a daemon: tokens, certificates; and a Unix socket. The test script makes the certificates. */

import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import test from "node:test";

import { NotAllowed, Unavailable } from "clearance";
import { connect } from "clearance/node";

import { client, daemon, folder, thrown } from "./daemon.js";

test("a token allows what its scopes say", async (t) => {
  const token = "a-token-that-only-reads";
  const file = join(await folder(t), "token");
  await writeFile(file, token);
  const address = await daemon(t, `[[grpc.tokens]]\nname = "reader"\nfile = "${file}"\nscopes = ["read"]\n`);
  assert.equal((await thrown(NotAllowed, client(t, address).listScenes())).reason, "NO_TOKEN");
  const stranger = client(t, address, { token: "some-other-token" });
  assert.equal((await thrown(NotAllowed, stranger.listScenes())).reason, "UNKNOWN_TOKEN");
  const reader = client(t, address, { token });
  assert.deepEqual(await reader.listScenes(), []);
  const missing = await thrown(NotAllowed, reader.createScene("cell"));
  assert.deepEqual([missing.reason, missing.scope], ["MISSING_SCOPE", "write"]);
  assert.throws(() => connect(address, { token: "not\nprintable" }), TypeError);
});

test("a Unix socket", async (t) => {
  const address = await daemon(t, "", `unix:${join(await folder(t), "clearance.sock")}`);
  await client(t, address).createScene("cell");
  assert.throws(() => connect(address, { ca: "something" }), TypeError);
});

test("certificates of both sides", async (t) => {
  const of = (name: string) => join(process.env["CERTIFICATES"] as string, name);
  const files = { certificate: of("server.pem"), key: of("server_key.pem"), client_ca: of("ca.pem") };
  const lines = Object.entries(files).map(([key, file]) => `${key} = "${file}"\n`);
  const address = (await daemon(t, `[grpc.tls]\n${lines.join("")}`)).replace(/.*:/, "localhost:");
  const options = {
    ca: await readFile(of("ca.pem")),
    certificate: await readFile(of("client.pem")),
    key: await readFile(of("client_key.pem")),
  };
  assert.ok((await client(t, `https://${address}`, options).serverInfo()).threads > 0);
  await thrown(Unavailable, client(t, address, { ca: options.ca }).serverInfo());
  await thrown(Unavailable, client(t, address, { ...options, ca: await readFile(of("other_ca.pem")) }).serverInfo());
  assert.throws(() => connect(`http://${address}`, options), TypeError);
  assert.throws(() => connect(address, { certificate: options.certificate }), TypeError);
});
