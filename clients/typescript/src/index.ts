/**
 * Ask a clearance daemon how far apart things are. `clearance/node` connects over gRPC, `clearance/web` over gRPC-Web from a page;
 * what they connect to is the same `Client`.
 *
 * Metres, radians, right-handed frames. What goes wrong with a request is a `ClearanceError`; geometry never is, it is a verdict.
 */
export * from "./answers.js";
export * from "./client.js";
export * from "./edits.js";
export * from "./errors.js";
export * from "./estimates.js";
export * from "./geometry.js";
export * from "./question.js";
export * from "./robots.js";
export * from "./scene.js";
export * as v1 from "./v1.js";
