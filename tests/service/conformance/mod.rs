//! What every door has to do. Each behaviour is written once, over [`Door`], and run through all of them; those of watches and of
//! streams over [`Watches`] and [`Streams`], and run through the doors that have them.

mod assets;
mod bad_input;
mod caps;
mod casts;
mod contacts;
mod decompositions;
mod derivatives;
mod effects;
mod estimates;
mod fields;
mod motions;
mod overlays;
mod patches;
mod poses;
mod query_streams;
mod questions;
mod revisions;
mod robots;
mod scene_watches;
mod scenes;
mod voxels;

/// Makes a test of each behaviour for one door.
macro_rules! through {
    ($module:ident, $door:ty, $($behaviour:ident),*) => {
        mod $module {
            $(#[tokio::test(flavor = "multi_thread")]
            async fn $behaviour() {
                use crate::support::{door::Door, watchdog::watched};
                let door = <$door>::open(super::limits()).await;
                watched(stringify!($behaviour), super::$behaviour(&door)).await;
            })*
        }
    };
}

/// Makes a test of each behaviour for each door.
macro_rules! through_every_door {
    ($($behaviour:ident),* $(,)?) => {
        super::through_doors_with_watches!($($behaviour),*);
        #[cfg(feature = "shared-memory")]
        super::through!(shared_memory, crate::support::shared_memory_door::SharedMemory, $($behaviour),*);
    };
}

/// Makes a test of each behaviour for each door that has watches.
macro_rules! through_doors_with_watches {
    ($($behaviour:ident),* $(,)?) => {
        super::through_doors_with_streams!($($behaviour),*);
        #[cfg(feature = "zenoh")]
        super::through!(zenoh, crate::support::zenoh_door::Zenoh, $($behaviour),*);
    };
}

/// Makes a test of each behaviour for each door that has streams of what is sent.
macro_rules! through_doors_with_streams {
    ($($behaviour:ident),* $(,)?) => {
        super::through!(in_process, crate::support::door::InProcess, $($behaviour),*);
        super::through!(grpc, crate::support::door::Grpc, $($behaviour),*);
        super::through!(grpc_unix, crate::support::door::GrpcUnix, $($behaviour),*);
    };
}

use {through, through_doors_with_streams, through_doors_with_watches, through_every_door};
