//! How much may be asked? Every cap of the service: its unit, its default, and what the caller sees when it is hit.
//!
//! Nothing grows without a bound that is written here. `docs/operations.md` lists the same table, and a test compares
//! them. The numeric constants of the kernel are elsewhere, in [`crate::geometry::tolerance`].

use serde::Deserialize;

/// All caps. The configuration file sets them under `[limits]`, by these names.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Limits {
    /// Size of one message, in either direction, bytes.
    pub max_message_bytes: usize,
    /// States or subjects of one question.
    pub max_items: usize,
    /// Numbers in the joint positions of one question.
    pub max_joint_values: usize,
    /// Pairs listed for one item of an answer.
    pub max_pairs: usize,
    /// Pairs of samples for the derivatives of one pair.
    pub max_derivative_samples: usize,
    /// States that one motion may be looked at in.
    pub max_motion_states: usize,
    /// Items that an estimate measures of its question.
    pub max_estimate_sample: usize,
    /// Pairings of an output and a tolerance that one estimate measures.
    pub max_estimate_rows: usize,
    /// How long an estimate measures, seconds.
    pub max_estimate_seconds: usize,
    /// Overlays of one question.
    pub max_overlays: usize,
    /// Edits and attached bodies of all overlays of one question together.
    pub max_overlay_edits: usize,
    /// Scenes of the daemon.
    pub max_scenes: usize,
    /// Bodies of one scene.
    pub max_bodies: usize,
    /// Robots that stand in one scene.
    pub max_robots_in_scene: usize,
    /// Entries for pairs of one scene: allowed collisions, margins and declared effects together.
    pub max_pair_entries: usize,
    /// Robot models of the daemon.
    pub max_robot_models: usize,
    /// Edits of one `Apply`.
    pub max_edits: usize,
    /// Revisions of a scene that can still be asked.
    pub snapshots_kept: usize,
    /// What the kept revisions of a scene may hold beside the oldest of them, bytes.
    pub max_kept_bytes: usize,
    /// Bodies listed by one `GetScene`.
    pub max_bodies_listed: usize,
    /// Idempotency keys remembered for one scene.
    pub idempotency_keys_kept: usize,
    /// Points of one convex hull before inner ones are left out.
    pub max_hull_points: usize,
    /// Triangles of one mesh.
    pub max_mesh_triangles: usize,
    /// Parts of one compound.
    pub max_compound_parts: usize,
    /// Samples of one height field.
    pub max_height_samples: usize,
    /// Points of one point cloud, or of one insertion into voxels.
    pub max_cloud_points: usize,
    /// Cells of one map of voxels.
    pub max_voxel_cells: usize,
    /// Groups of one body.
    pub max_groups: usize,
    /// Size of one uploaded file, bytes.
    pub max_asset_bytes: usize,
    /// Size of all uploaded files together, bytes.
    pub max_total_asset_bytes: usize,
    /// Size of a URDF or SRDF text, bytes.
    pub max_description_bytes: usize,
    /// Length of a name, bytes of UTF-8.
    pub max_name_bytes: usize,
    /// Questions being answered or waiting for a thread, over all scenes.
    pub max_queries_in_flight: usize,
    /// Changes of one scene waiting for their turn.
    pub max_queued_writes: usize,
    /// Callers that watch scenes or contacts, over all scenes.
    pub max_watchers: usize,
    /// Streams of poses or of questions, over all scenes.
    pub max_streams: usize,
    /// Questions of one stream being answered at a time.
    pub max_stream_in_flight: usize,
    /// Pairs in contact or undecided that one watcher may have.
    pub max_contacts: usize,
    /// Uploads and robot loadings under way.
    pub max_uploads_in_flight: usize,
    /// Longest time a question may take, seconds.
    pub max_deadline_seconds: usize,
    /// Connections of the gRPC door.
    pub max_connections: usize,
    /// How long a connection may take to shake hands and to begin to speak, seconds.
    pub max_handshake_seconds: usize,
    /// Calls that one client has under way.
    pub max_client_calls: usize,
    /// Items and edits of one client in a second, on the mean; 0: as many as it likes.
    pub max_client_items_per_second: usize,
    /// Bytes of messages from and to one client in a second, on the mean; 0: as many as it likes.
    pub max_client_bytes_per_second: usize,
    /// Steps of a scene that zenoh's subscribers can recover by themselves.
    pub max_zenoh_cache: usize,
    /// Clients of the shared-memory door.
    pub max_shared_memory_clients: usize,
    /// Size of one request through shared memory, bytes; each client keeps room for three.
    pub max_shared_memory_request_bytes: usize,
    /// Size of one answer through shared memory, bytes; the daemon keeps room for two for each client.
    pub max_shared_memory_response_bytes: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            max_message_bytes: 64 << 20,
            max_items: 100_000,
            max_joint_values: 2_000_000,
            max_pairs: 100_000,
            max_derivative_samples: 10_000,
            max_motion_states: 100_000,
            max_estimate_sample: 256,
            max_estimate_rows: 64,
            max_estimate_seconds: 2,
            max_overlays: 1_024,
            max_overlay_edits: 16_384,
            max_scenes: 1_000,
            max_bodies: 2_000_000,
            max_robots_in_scene: 64,
            max_pair_entries: 100_000,
            max_robot_models: 256,
            max_edits: 100_000,
            snapshots_kept: 64,
            max_kept_bytes: 2 << 30,
            max_bodies_listed: 100_000,
            idempotency_keys_kept: 1_024,
            max_hull_points: 100_000,
            max_mesh_triangles: 2_000_000,
            max_compound_parts: 10_000,
            max_height_samples: 20_000_000,
            max_cloud_points: 5_000_000,
            max_voxel_cells: 20_000_000,
            max_groups: 64,
            max_asset_bytes: 256 << 20,
            max_total_asset_bytes: 2 << 30,
            max_description_bytes: 16 << 20,
            max_name_bytes: 256,
            max_queries_in_flight: 64,
            max_queued_writes: 64,
            max_watchers: 32,
            max_streams: 64,
            max_stream_in_flight: 16,
            max_contacts: 250_000,
            max_uploads_in_flight: 8,
            max_deadline_seconds: 600,
            max_connections: 512,
            max_handshake_seconds: 5,
            max_client_calls: 512,
            max_client_items_per_second: 0,
            max_client_bytes_per_second: 0,
            max_zenoh_cache: 256,
            max_shared_memory_clients: 8,
            max_shared_memory_request_bytes: 4 << 20,
            max_shared_memory_response_bytes: 3 << 20,
        }
    }
}

/// One cap as it is shown to people and programs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Limit {
    /// The field of [`Limits`].
    pub name: &'static str,
    /// What is counted.
    pub unit: &'static str,
    /// As it is set.
    pub value: u64,
    /// To a request beyond it.
    pub what_happens: &'static str,
}

const EXHAUSTED: &str = "RESOURCE_EXHAUSTED naming limit, asked and allowed";
const EXHAUSTED_FOR_NOW: &str = "RESOURCE_EXHAUSTED naming limit, asked and allowed, and when to ask again";
const EXHAUSTED_AT_THE_END: &str = "the stream ends with RESOURCE_EXHAUSTED naming limit, asked and allowed";

impl Limits {
    /// Every cap, in the order of the fields.
    #[must_use]
    pub fn table(&self) -> Vec<Limit> {
        // Written out, so that a new field does not compile until it has its line.
        let Self {
            max_message_bytes,
            max_items,
            max_joint_values,
            max_pairs,
            max_derivative_samples,
            max_motion_states,
            max_estimate_sample,
            max_estimate_rows,
            max_estimate_seconds,
            max_overlays,
            max_overlay_edits,
            max_scenes,
            max_bodies,
            max_robots_in_scene,
            max_pair_entries,
            max_robot_models,
            max_edits,
            snapshots_kept,
            max_kept_bytes,
            max_bodies_listed,
            idempotency_keys_kept,
            max_hull_points,
            max_mesh_triangles,
            max_compound_parts,
            max_height_samples,
            max_cloud_points,
            max_voxel_cells,
            max_groups,
            max_asset_bytes,
            max_total_asset_bytes,
            max_description_bytes,
            max_name_bytes,
            max_queries_in_flight,
            max_queued_writes,
            max_watchers,
            max_streams,
            max_stream_in_flight,
            max_contacts,
            max_uploads_in_flight,
            max_deadline_seconds,
            max_connections,
            max_handshake_seconds,
            max_client_calls,
            max_client_items_per_second,
            max_client_bytes_per_second,
            max_zenoh_cache,
            max_shared_memory_clients,
            max_shared_memory_request_bytes,
            max_shared_memory_response_bytes,
        } = *self;
        let row = |name, value: usize, unit, what_happens| Limit { name, unit, value: value as u64, what_happens };
        vec![
            row("max_message_bytes", max_message_bytes, "bytes per message", EXHAUSTED),
            row("max_items", max_items, "items per question", EXHAUSTED),
            row("max_joint_values", max_joint_values, "numbers per question", EXHAUSTED),
            row("max_pairs", max_pairs, "pairs listed per item", EXHAUSTED),
            row(
                "max_derivative_samples",
                max_derivative_samples,
                "pairs of samples per pair with derivatives",
                EXHAUSTED,
            ),
            row("max_motion_states", max_motion_states, "states per motion", EXHAUSTED),
            row(
                "max_estimate_sample",
                max_estimate_sample,
                "items that an estimate measures",
                "a larger sample is cut down to this; the answer says how large it was",
            ),
            row("max_estimate_rows", max_estimate_rows, "outputs times tolerances per estimate", EXHAUSTED),
            row(
                "max_estimate_seconds",
                max_estimate_seconds,
                "seconds that an estimate measures",
                "a longer time is shortened to this; an estimate without one gets it",
            ),
            row("max_overlays", max_overlays, "overlays per question", EXHAUSTED),
            row("max_overlay_edits", max_overlay_edits, "edits of all overlays per question", EXHAUSTED),
            row("max_scenes", max_scenes, "scenes", EXHAUSTED),
            row("max_bodies", max_bodies, "bodies per scene", EXHAUSTED),
            row("max_robots_in_scene", max_robots_in_scene, "robots per scene", EXHAUSTED),
            row("max_pair_entries", max_pair_entries, "entries for pairs per scene", EXHAUSTED),
            row("max_robot_models", max_robot_models, "robot models", EXHAUSTED),
            row("max_edits", max_edits, "edits per Apply", EXHAUSTED),
            row("snapshots_kept", snapshots_kept, "revisions per scene", "OUT_OF_RANGE naming the oldest kept"),
            row(
                "max_kept_bytes",
                max_kept_bytes,
                "bytes per scene, beside its oldest kept revision",
                "the oldest revisions are let go early: OUT_OF_RANGE naming the oldest kept",
            ),
            row("max_bodies_listed", max_bodies_listed, "bodies per GetScene", EXHAUSTED),
            row(
                "idempotency_keys_kept",
                idempotency_keys_kept,
                "keys per scene",
                "the oldest key is forgotten: edits sent with it again are applied again",
            ),
            row("max_hull_points", max_hull_points, "points per hull", EXHAUSTED),
            row("max_mesh_triangles", max_mesh_triangles, "triangles per mesh", EXHAUSTED),
            row("max_compound_parts", max_compound_parts, "parts per compound", EXHAUSTED),
            row("max_height_samples", max_height_samples, "samples per height field", EXHAUSTED),
            row("max_cloud_points", max_cloud_points, "points per point cloud or insertion", EXHAUSTED),
            row("max_voxel_cells", max_voxel_cells, "cells per map of voxels", EXHAUSTED),
            row("max_groups", max_groups, "groups per body", EXHAUSTED),
            row("max_asset_bytes", max_asset_bytes, "bytes per uploaded file", EXHAUSTED),
            row("max_total_asset_bytes", max_total_asset_bytes, "bytes of all uploaded files", EXHAUSTED),
            row("max_description_bytes", max_description_bytes, "bytes per URDF or SRDF", EXHAUSTED),
            row("max_name_bytes", max_name_bytes, "bytes per name", EXHAUSTED),
            row("max_queries_in_flight", max_queries_in_flight, "questions at a time", EXHAUSTED),
            row("max_queued_writes", max_queued_writes, "waiting changes per scene", EXHAUSTED),
            row("max_watchers", max_watchers, "watchers at a time", EXHAUSTED),
            row("max_streams", max_streams, "streams of poses or questions at a time", EXHAUSTED),
            row(
                "max_stream_in_flight",
                max_stream_in_flight,
                "questions of one stream at a time",
                "the daemon does not read on until one is answered; asking for more: RESOURCE_EXHAUSTED",
            ),
            row("max_contacts", max_contacts, "contacts per watcher", EXHAUSTED_AT_THE_END),
            row("max_uploads_in_flight", max_uploads_in_flight, "uploads at a time", EXHAUSTED),
            row(
                "max_deadline_seconds",
                max_deadline_seconds,
                "seconds per question",
                "a longer deadline is shortened to this; a question without one gets it",
            ),
            row("max_connections", max_connections, "connections at a time", "the connection is closed at once"),
            row(
                "max_handshake_seconds",
                max_handshake_seconds,
                "seconds for TLS, and again for the first bytes",
                "the connection is closed",
            ),
            row("max_client_calls", max_client_calls, "calls of one client at a time", EXHAUSTED),
            row(
                "max_client_items_per_second",
                max_client_items_per_second,
                "items and edits of one client per second; 0: any number",
                EXHAUSTED_FOR_NOW,
            ),
            row(
                "max_client_bytes_per_second",
                max_client_bytes_per_second,
                "bytes from and to one client per second; 0: any number",
                EXHAUSTED_FOR_NOW,
            ),
            row(
                "max_zenoh_cache",
                max_zenoh_cache,
                "steps of a scene kept for zenoh's subscribers",
                "a subscriber that missed more is shown a gap, and asks the scene's log",
            ),
            row(
                "max_shared_memory_clients",
                max_shared_memory_clients,
                "clients of the shared-memory door",
                "connecting fails and names the number",
            ),
            row(
                "max_shared_memory_request_bytes",
                max_shared_memory_request_bytes,
                "bytes per request through shared memory",
                "the client refuses the request and names both numbers",
            ),
            row(
                "max_shared_memory_response_bytes",
                max_shared_memory_response_bytes,
                "bytes per answer through shared memory",
                EXHAUSTED,
            ),
        ]
    }
}

/// A request beyond a cap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{limit} exceeded: asked for {asked}, allowed is {allowed}")]
pub struct LimitExceeded {
    /// The field of [`Limits`].
    pub limit: &'static str,
    /// How much the request needs.
    pub asked: u64,
    /// How much there may be.
    pub allowed: u64,
}

impl LimitExceeded {
    /// Holds `asked` against a cap.
    ///
    /// # Errors
    /// More is asked than is allowed.
    pub fn check(limit: &'static str, asked: usize, allowed: usize) -> Result<(), Self> {
        if asked <= allowed {
            return Ok(());
        }
        Err(Self { limit, asked: asked as u64, allowed: allowed as u64 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_names_each_field_once() {
        let limits = Limits::default();
        let shown = format!("{limits:?}");
        let table = limits.table();
        for limit in &table {
            assert!(shown.contains(&format!("{}: {}", limit.name, limit.value)), "{limit:?}");
            assert_eq!(table.iter().filter(|other| other.name == limit.name).count(), 1, "{}", limit.name);
        }
        assert_eq!(table.len(), shown.matches(": ").count());
    }

    #[test]
    fn a_request_at_the_cap_passes_and_one_beyond_is_told_both_numbers() {
        assert_eq!(LimitExceeded::check("max_items", 5, 5), Ok(()));
        let error = LimitExceeded::check("max_items", 6, 5).unwrap_err();
        assert_eq!(error.to_string(), "max_items exceeded: asked for 6, allowed is 5");
    }
}
