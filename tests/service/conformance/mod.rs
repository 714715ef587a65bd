//! What every door has to do. Each behaviour is written once, over [`Door`], and run through all of them.

mod assets;
mod bad_input;
mod caps;
mod casts;
mod contacts;
mod decompositions;
mod fields;
mod motions;
mod overlays;
mod poses;
mod query_streams;
mod questions;
mod revisions;
mod robots;
mod scene_watches;
mod scenes;
mod voxels;

/// Makes a test of each behaviour for each door.
macro_rules! through_every_door {
    ($($behaviour:ident),* $(,)?) => {
        mod in_process {
            $(#[tokio::test(flavor = "multi_thread")]
            async fn $behaviour() {
                use crate::support::{door::{Door, InProcess}, watchdog::watched};
                let door = InProcess::open(super::limits()).await;
                watched(stringify!($behaviour), super::$behaviour(&door)).await;
            })*
        }
        mod grpc {
            $(#[tokio::test(flavor = "multi_thread")]
            async fn $behaviour() {
                use crate::support::{door::{Door, Grpc}, watchdog::watched};
                let door = Grpc::open(super::limits()).await;
                watched(stringify!($behaviour), super::$behaviour(&door)).await;
            })*
        }
        mod grpc_unix {
            $(#[tokio::test(flavor = "multi_thread")]
            async fn $behaviour() {
                use crate::support::{door::{Door, GrpcUnix}, watchdog::watched};
                let door = GrpcUnix::open(super::limits()).await;
                watched(stringify!($behaviour), super::$behaviour(&door)).await;
            })*
        }
    };
}

use through_every_door;
