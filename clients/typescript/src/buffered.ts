/**
 * Streams of requests from a browser. `fetch` sends a body that is complete, and gRPC-Web in general stops there; but the body may
 * hold several messages, and the daemon reads them one by one. So they are collected, sent at once, and answered after that.
 */

import { createContextValues, type Interceptor, type StreamResponse, type Transport } from "@connectrpc/connect";
import {
  createClientMethodSerializers,
  createEnvelopeReadableStream,
  createMethodUrl,
  encodeEnvelopes,
  runStreamingCall,
} from "@connectrpc/connect/protocol";
import { requestHeader, trailerFlag, trailerParse, validateResponse, validateTrailer } from "@connectrpc/connect/protocol-grpc-web";

interface Options {
  baseUrl: string;
  interceptors: Interceptor[];
  defaultTimeoutMs: number;
}

/** The transport, with streams of requests added. */
export function withBufferedRequests(transport: Transport, options: Options): Transport {
  return {
    unary: (...call) => transport.unary(...call),
    async stream(method, signal, timeoutMs, header, input, contextValues) {
      if (method.methodKind === "server_streaming") {
        return await transport.stream(method, signal, timeoutMs, header, input, contextValues);
      }
      const { serialize, parse } = createClientMethodSerializers(method, true);
      const time = timeoutMs === undefined ? options.defaultTimeoutMs : timeoutMs <= 0 ? undefined : timeoutMs;
      return await runStreamingCall({
        interceptors: options.interceptors,
        ...(signal !== undefined && { signal }),
        ...(time !== undefined && { timeoutMs: time }),
        req: {
          stream: true,
          service: method.parent,
          method,
          requestMethod: "POST",
          url: createMethodUrl(options.baseUrl, method),
          header: requestHeader(true, time, header, false),
          contextValues: contextValues ?? createContextValues(),
          message: input,
        },
        next: async (request) => {
          const messages = [];
          for await (const message of request.message) messages.push({ flags: 0, data: serialize(message) });
          const response = await fetch(request.url, {
            redirect: "error",
            method: "POST",
            headers: request.header,
            signal: request.signal,
            body: encodeEnvelopes(...messages),
          });
          const { foundStatus, headerError } = validateResponse(response.status, response.headers);
          if (headerError !== undefined) throw headerError;
          const trailer = new Headers();
          // An answer without a body has its whole story in its headers.
          const message = foundStatus ? none<never>() : answers(response, trailer, parse);
          return { ...request, header: response.headers, trailer, message } as StreamResponse<typeof method.input, typeof method.output>;
        },
      });
    },
  };
}

async function* answers<T>(response: Response, trailerTarget: Headers, parse: (data: Uint8Array) => T): AsyncIterable<T> {
  if (response.body === null) throw new TypeError("the response has no body");
  const reader = createEnvelopeReadableStream(response.body).getReader();
  let complete = false;
  for (let read = await reader.read(); !read.done; read = await reader.read()) {
    const { flags, data } = read.value;
    if ((flags & trailerFlag) === trailerFlag) {
      const trailer = trailerParse(data);
      validateTrailer(trailer, response.headers);
      trailer.forEach((value, key) => trailerTarget.set(key, value));
      complete = true;
    } else {
      yield parse(data);
    }
  }
  if (!complete) throw new TypeError("the response ended without a trailer");
}

async function* none<T>(): AsyncIterable<T> {}

