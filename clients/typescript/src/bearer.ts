/** What every kind of connection brings to each call. */

import type { Interceptor } from "@connectrpc/connect";

export interface CommonOptions {
  /** Goes with every call. Without TLS it can be read on its way. */
  token?: string;
  /** The deadline of every call that has none of its own, milliseconds; 60 000 unless said otherwise. A call's own 0 is none. */
  timeoutMs?: number;
}

export function bearer(token: string | undefined): Interceptor[] {
  if (token === undefined) return [];
  // The text of a token has no place in an error.
  if (!/^[!-~]+$/.test(token)) throw new TypeError("the token is not printable ASCII");
  return [
    (next) => (request) => {
      request.header.set("authorization", `Bearer ${token}`);
      return next(request);
    },
  ];
}
