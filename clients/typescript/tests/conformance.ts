/**
 * The recorded answers of tests/data/conformance are brought, byte for byte, from Node and from a browser;
 * tests/clients/record.rs says what a line means.
 */

import {
  clone,
  fromBinary,
  toBinary,
  type DescMessage,
  type DescMethodUnary,
  type DescMethodBiDiStreaming,
  type Message,
  type MessageShape,
} from "@bufbuild/protobuf";
import { reflect, type ReflectMessage } from "@bufbuild/protobuf/reflect";

import { ClearanceError, v1, type Client } from "clearance";

/** Asks what the records have; tells how many lines there were of each kind, and what was different. */
export async function conform(client: Client, records: string, file: (path: string) => Promise<Uint8Array>) {
  const seen: Record<string, number> = {};
  const different: string[] = [];
  for (const line of records.trimEnd().split("\n")) {
    const [kind = "", first = "", request = "", ...rest] = line.split(" ");
    if (kind === "#") continue;
    seen[kind] = (seen[kind] ?? 0) + 1;
    const recorded = rest.join(" ");
    let brought = recorded;
    if (kind === "asset") await client.upload([await file(first)]);
    else if (kind === "ask") brought = await ask(client, first, request);
    else if (kind === "refuse") brought = await refusal(client, first, request);
    else brought = await stream(client, first, request);
    if (brought !== recorded) different.push(`${kind} ${first} ${request.slice(0, 80)}\nbrought  ${brought}\nrecorded ${recorded}`);
  }
  return { seen, different };
}

async function ask(client: Client, name: string, request: string): Promise<string> {
  const method = methodOf(name) as DescMethodUnary;
  const question = fromBinary(method.input, bytesOf(request));
  const { message } = await client.transport.unary(method, undefined, 30_000, undefined, question);
  return canonical(method.output, message);
}

async function refusal(client: Client, name: string, request: string): Promise<string> {
  try {
    await ask(client, name, request);
  } catch (error) {
    if (error instanceof ClearanceError) return `${error.code} ${error.reason} ${error.field ?? "-"}`;
    throw error;
  }
  return "no refusal";
}

async function stream(client: Client, name: string, requests: string): Promise<string> {
  const method = methodOf(name) as DescMethodBiDiStreaming;
  async function* questions() {
    for (const request of requests.split(",")) yield fromBinary(method.input, bytesOf(request));
  }
  const answers: string[] = [];
  const { message } = await client.transport.stream(method, undefined, 30_000, undefined, questions());
  for await (const answer of message) answers.push(canonical(method.output, answer));
  return answers.join(",");
}

function methodOf(name: string) {
  const [service = "", method = ""] = name.split("/");
  const services: Record<string, { methods: { name: string }[] }> = {
    Scenes: v1.Scenes,
    Assets: v1.Assets,
    Robots: v1.Robots,
    Queries: v1.Queries,
  };
  const found = services[service]?.methods.find((each) => each.name === method);
  if (found === undefined) throw new Error(`no such method: ${name}`);
  return found;
}

function bytesOf(digits: string): Uint8Array {
  return Uint8Array.from(digits.match(/[0-9a-f]{2}/g) ?? [], (byte) => parseInt(byte, 16));
}

function canonical<D extends DescMessage>(schema: D, message: MessageShape<D>): string {
  const copy = clone(schema, message);
  clear(reflect(schema, copy as Message as MessageShape<D>));
  const bytes = toBinary(schema, copy);
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("") || "-";
}

/** Without epochs and counts of nodes. */
function clear(message: ReflectMessage): void {
  for (const field of message.fields) {
    if (!message.isSet(field)) continue;
    if (field.name === "epoch" || (field.name === "nodes" && message.desc.name === "Cost")) message.clear(field);
    else if (field.fieldKind === "message") clear(message.get(field));
    else if (field.fieldKind === "list" && field.listKind === "message") {
      for (const each of message.get(field)) clear(each as ReflectMessage);
    }
  }
}
