/** The messages and services of `proto/clearance/v1`, generated. */
export * from "./v1/cast_pb.js";
export * from "./v1/contact_pb.js";
export * from "./v1/estimate_pb.js";
export * from "./v1/geometry_pb.js";
export * from "./v1/health_pb.js";
export * from "./v1/motion_pb.js";
export * from "./v1/overlay_pb.js";
export * from "./v1/query_pb.js";
export * from "./v1/robot_pb.js";
export * from "./v1/scene_pb.js";
export * from "./v1/service_pb.js";
export * from "./v1/stream_pb.js";
