/** From Node: gRPC, and robots from files. */

import { readFile } from "node:fs/promises";
import * as net from "node:net";
import { dirname, isAbsolute, join } from "node:path";
import * as tls from "node:tls";

import { createGrpcTransport } from "@connectrpc/connect-node";

import { bearer, type CommonOptions } from "./bearer.js";
import { Client } from "./client.js";
import { meshNames, resolveMesh, type RobotDescription } from "./robots.js";

/** Where `clearance serve` listens unless told otherwise. */
export const DEFAULT_ADDRESS = "127.0.0.1:50551";

/** What a client shows the daemon, and whom it trusts. */
export interface Options extends CommonOptions {
  /** Certificates (PEM) of which one must have signed the daemon's; without them those that Node brings along are trusted. */
  ca?: string | Buffer;
  /** The client's own certificate and its key (PEM). */
  certificate?: string | Buffer;
  key?: string | Buffer;
}

/**
 * A client of `HOST:PORT`, `http://HOST:PORT`, `https://HOST:PORT` or `unix:PATH`. A bare `HOST:PORT` means TLS if the options have
 * anything of TLS. The connection is made when it is needed: a daemon that is not there shows with the first call.
 */
export function connect(address: string = DEFAULT_ADDRESS, options: Options = {}): Client {
  const { ca, certificate, key } = options;
  if ((certificate === undefined) !== (key === undefined)) throw new TypeError("certificate and key go together");
  const hasTls = ca !== undefined || certificate !== undefined;
  const baseUrl = urlOf(address, hasTls);
  if (hasTls && baseUrl.startsWith("http://")) {
    throw new TypeError(`${address} has no TLS: ca, certificate and key have no meaning there`);
  }
  const path = address.startsWith("unix:") ? address.slice("unix:".length) : undefined;
  // The sockets are made here, because closing them is the only end of a session that cannot cross a GOAWAY of the daemon's:
  // `Http2SessionManager.abort` takes its listener off a session that may be about to emit an error.
  const sockets = new Set<net.Socket>();
  let closed = false;
  const createConnection = ({ protocol, hostname, port }: URL): net.Socket => {
    if (closed) throw new Error("the client is closed");
    const host = hostname.replace(/^\[(.*)\]$/, "$1");
    const where = path !== undefined ? { path } : { host, port: Number(port || (protocol === "https:" ? 443 : 80)), noDelay: true };
    const socket = protocol === "https:" ? tls.connect({ ...where, ...tlsOptions(host, options) }) : net.connect(where);
    sockets.add(socket);
    socket.once("close", () => sockets.delete(socket));
    return socket;
  };
  const transport = createGrpcTransport({
    baseUrl,
    nodeOptions: { createConnection },
    interceptors: bearer(options.token),
    defaultTimeoutMs: options.timeoutMs ?? 60_000,
    acceptCompression: [],
  });
  return new Client(transport, () => {
    closed = true;
    for (const socket of sockets) socket.destroy();
  });
}

function tlsOptions(host: string, { ca, certificate, key }: Options): tls.ConnectionOptions {
  return {
    ALPNProtocols: ["h2"],
    ...(net.isIP(host) === 0 && { servername: host }),
    ...(ca !== undefined && { ca }),
    ...(certificate !== undefined && { cert: certificate }),
    ...(key !== undefined && { key }),
  };
}

/**
 * Reads a robot from this machine's disk: the texts, and every mesh file that a collision shape names. `package://NAME/rest` is
 * `rest` in `packages[NAME]`, else in the URDF's own folder; any other name is a path from that folder.
 */
export async function readRobot(
  urdf: string,
  srdf?: string,
  packages: Readonly<Record<string, string>> = {},
): Promise<RobotDescription> {
  const description = { urdf: await readFile(urdf, "utf8"), meshes: new Map<string, Uint8Array>() };
  for (const name of meshNames(description.urdf)) {
    const [folder, path] = resolveMesh(name, dirname(urdf), packages);
    description.meshes.set(name, await readFile(isAbsolute(path) ? path : join(folder, path)));
  }
  return srdf === undefined ? description : { ...description, srdf: await readFile(srdf, "utf8") };
}

function urlOf(address: string, hasTls: boolean): string {
  // The host of a Unix socket is nowhere else: its path has characters that HTTP/2 servers in Rust refuse.
  if (address.startsWith("unix:")) return "http://localhost";
  if (/^https?:\/\//.test(address)) return address;
  return `${hasTls ? "https" : "http"}://${address}`;
}
