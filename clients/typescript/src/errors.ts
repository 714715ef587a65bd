/** What can go wrong with a request. Geometry never does: it is a verdict. */

import { Code, ConnectError, type Transport } from "@connectrpc/connect";

import * as v1 from "./v1.js";

/** A request was refused or could not be delivered. What the daemon did not say is undefined. */
export class ClearanceError extends Error {
  override readonly name: string = "ClearanceError";
  /** gRPC's name of the kind of error, for example `INVALID_ARGUMENT`. */
  readonly code: string;
  /** For programs, for example `INVALID_FIELD`; see `ErrorReason` in service.proto. */
  readonly reason: string | undefined;
  /** The field that cannot be as it is, for example `items[3].shape.box.half_extents.x`. */
  readonly field: string | undefined;
  /** Of a list of edits, subjects or the like: which element the field is in. */
  readonly item: number | undefined;
  /** The cap that was hit, how much was asked, how much is allowed. */
  readonly limit: string | undefined;
  readonly asked: number | undefined;
  readonly allowed: number | undefined;
  /** When the limit lets this client in again, milliseconds. */
  readonly retryAfterMs: number | undefined;
  /** The scope that the token lacks, `read` or `write`. */
  readonly scope: string | undefined;
  /** The scene as it is now, where it is not as was expected. */
  readonly epoch: bigint | undefined;
  readonly revision: bigint | undefined;
  readonly oldestRevision: bigint | undefined;

  constructor(code: Code, message: string, of: (key: string) => string | undefined, cause?: unknown) {
    super(`${codeName(code)}: ${message}`, { cause });
    const number = (key: string) => mapped(of(key), Number);
    const whole = (key: string) => mapped(of(key), BigInt);
    this.code = codeName(code);
    this.reason = of("clearance-reason");
    this.field = of("clearance-field");
    this.item = mapped(/^\w+\[(\d+)\]/.exec(this.field ?? "")?.[1], Number);
    this.limit = of("clearance-limit");
    this.asked = number("clearance-asked");
    this.allowed = number("clearance-allowed");
    this.retryAfterMs = number("clearance-retry-after-ms");
    this.scope = of("clearance-scope");
    this.epoch = whole("clearance-epoch");
    this.revision = whole("clearance-revision");
    this.oldestRevision = whole("clearance-oldest-revision");
  }
}

/** A field cannot be as it is; `field` and `item` say which. */
export class InvalidRequest extends ClearanceError {
  override readonly name = "InvalidRequest";
}
/** A scene, body, robot, model, asset or group is not there. */
export class NotFound extends ClearanceError {
  override readonly name = "NotFound";
}
/** The scene is not as the request needs it: a taken name, an edit that does not fit, another revision or epoch. */
export class Conflict extends ClearanceError {
  override readonly name = "Conflict";
}
/** The revision asked for is not kept any more; `oldestRevision` is. */
export class RevisionGone extends ClearanceError {
  override readonly name = "RevisionGone";
}
/** A cap of the daemon; `limit`, `asked` and `allowed` say which, `retryAfterMs` when to ask again if time helps. */
export class LimitExceeded extends ClearanceError {
  override readonly name = "LimitExceeded";
}
/** The daemon wants a token, does not know this one, or it lacks `scope`; `reason` says which. */
export class NotAllowed extends ClearanceError {
  override readonly name = "NotAllowed";
}
/** Nothing could be answered in time. */
export class DeadlineExceeded extends ClearanceError {
  override readonly name = "DeadlineExceeded";
}
/** No daemon there, one that shuts down, or a revision that did not come in time. */
export class Unavailable extends ClearanceError {
  override readonly name = "Unavailable";
}

const kinds: Partial<Record<Code, typeof ClearanceError>> = {
  [Code.InvalidArgument]: InvalidRequest,
  [Code.NotFound]: NotFound,
  [Code.AlreadyExists]: Conflict,
  [Code.FailedPrecondition]: Conflict,
  [Code.Aborted]: Conflict,
  [Code.OutOfRange]: RevisionGone,
  [Code.ResourceExhausted]: LimitExceeded,
  [Code.Unauthenticated]: NotAllowed,
  [Code.PermissionDenied]: NotAllowed,
  [Code.DeadlineExceeded]: DeadlineExceeded,
  [Code.Unavailable]: Unavailable,
};

/** The error of one question of a stream: as a call of its own would have thrown. */
export function refused(refusal: v1.QueryError): ClearanceError {
  const Kind = kinds[refusal.code as Code] ?? ClearanceError;
  const reason = v1.ErrorReason[refusal.reason];
  return new Kind(refusal.code, refusal.message, (key) => (key === "clearance-reason" ? reason : refusal.details[key]));
}

/** Every call of the transport throws errors of this module. */
export function translating(transport: Transport): Transport {
  return {
    async unary(...call) {
      try {
        return await transport.unary(...call);
      } catch (error) {
        throw translated(error);
      }
    },
    async stream(...call) {
      try {
        const response = await transport.stream(...call);
        return { ...response, message: translatingMessages(response.message) };
      } catch (error) {
        throw translated(error);
      }
    },
  };
}

async function* translatingMessages<T>(messages: AsyncIterable<T>): AsyncIterable<T> {
  try {
    yield* messages;
  } catch (error) {
    throw translated(error);
  }
}

function translated(error: unknown): ClearanceError {
  if (error instanceof ClearanceError) return error;
  const said = ConnectError.from(error);
  const code = isConnection(said) ? Code.Unavailable : said.code;
  const Kind = kinds[code] ?? ClearanceError;
  return new Kind(code, said.rawMessage, (key) => said.metadata.get(key) ?? undefined, error);
}

/** Whether nobody was reached: `fetch` says so with a TypeError, Node with an error of TLS, TCP or HTTP/2 that has a code. */
function isConnection({ code, cause }: ConnectError): boolean {
  if (code === Code.Unknown) return cause instanceof TypeError;
  return code === Code.Internal && cause instanceof Error && "code" in cause && typeof cause.code === "string";
}

/** `InvalidArgument` is `INVALID_ARGUMENT`. */
function codeName(code: Code): string {
  return (Code[code] ?? `code ${code}`).replace(/(?<=[a-z])(?=[A-Z])/g, "_").toUpperCase();
}

function mapped<T>(text: string | undefined, to: (text: string) => T): T | undefined {
  return text === undefined || !/^\d+$/.test(text) ? undefined : to(text);
}
