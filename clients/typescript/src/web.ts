/** From a page: gRPC-Web, and robots from URLs. The daemon's `grpc.web.allowed_origins` has to name the page's origin. */

import { createGrpcWebTransport } from "@connectrpc/connect-web";

import { bearer, type CommonOptions } from "./bearer.js";
import { Client } from "./client.js";
import { withBufferedRequests } from "./buffered.js";
import { meshNames, resolveMesh, type RobotDescription } from "./robots.js";

/** What a client shows the daemon. */
export type Options = CommonOptions;

/**
 * A client of a daemon at `http://HOST:PORT` or `https://HOST:PORT`. Browsers cannot send while they receive: of `QueryStream` and
 * `PoseStream` all messages are sent first.
 */
export function connect(url: string, options: Options = {}): Client {
  const transport = {
    baseUrl: url,
    interceptors: bearer(options.token),
    defaultTimeoutMs: options.timeoutMs ?? 60_000,
  };
  return new Client(withBufferedRequests(createGrpcWebTransport(transport), transport));
}

/**
 * Fetches a robot: the texts, and every mesh file that a collision shape names. `package://NAME/rest` is `rest` from the URL
 * `packages[NAME]`, else from the URDF's own folder; any other name is relative to that folder.
 */
export async function fetchRobot(
  urdf: string | URL,
  srdf?: string | URL,
  packages: Readonly<Record<string, string>> = {},
): Promise<RobotDescription> {
  const at = new URL(urdf, document.baseURI);
  const description = { urdf: await (await fetched(at)).text(), meshes: new Map<string, Uint8Array>() };
  const files = meshNames(description.urdf).map(async (name) => {
    const [folder, path] = resolveMesh(name, new URL(".", at).href, packages);
    const base = folder.endsWith("/") ? folder : `${folder}/`;
    const file = await fetched(new URL(path, new URL(base, document.baseURI)));
    return [name, new Uint8Array(await file.arrayBuffer())] as const;
  });
  for (const [name, file] of await Promise.all(files)) description.meshes.set(name, file);
  if (srdf === undefined) return description;
  return { ...description, srdf: await (await fetched(new URL(srdf, document.baseURI))).text() };
}

async function fetched(url: URL): Promise<Response> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url.href}: ${response.status} ${response.statusText}`);
  return response;
}
