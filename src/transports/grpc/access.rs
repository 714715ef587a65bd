//! Which rpc needs which scope? The one table; a test holds it against the descriptors of everything the door serves.

use std::fmt;

/// What a token allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    /// Questions, and looking at what is there.
    Read,
    /// Changes: scenes, uploads, robots.
    Write,
}

impl fmt::Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Read => "read",
            Self::Write => "write",
        })
    }
}

/// What a call needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Need {
    /// Nothing: anybody may ask.
    Nothing,
    /// A token with this scope.
    Scope(Scope),
}

const OPEN: Need = Need::Nothing;
const READ: Need = Need::Scope(Scope::Read);
const WRITE: Need = Need::Scope(Scope::Write);

/// Service, method, need; in the order of the files.
const TABLE: &[(&str, &str, Need)] = &[
    ("clearance.v1.Scenes", "CreateScene", WRITE),
    ("clearance.v1.Scenes", "ListScenes", READ),
    ("clearance.v1.Scenes", "GetScene", READ),
    ("clearance.v1.Scenes", "GetSceneHealth", READ),
    ("clearance.v1.Scenes", "DeleteScene", WRITE),
    ("clearance.v1.Scenes", "Apply", WRITE),
    ("clearance.v1.Scenes", "Watch", READ),
    ("clearance.v1.Scenes", "PoseStream", WRITE),
    ("clearance.v1.Assets", "HasAssets", READ),
    ("clearance.v1.Assets", "PutAsset", WRITE),
    ("clearance.v1.Assets", "DescribeMesh", READ),
    ("clearance.v1.Robots", "LoadRobot", WRITE),
    ("clearance.v1.Robots", "ListRobots", READ),
    ("clearance.v1.Robots", "GetRobot", READ),
    ("clearance.v1.Queries", "CheckStates", READ),
    ("clearance.v1.Queries", "Collide", READ),
    ("clearance.v1.Queries", "Distance", READ),
    ("clearance.v1.Queries", "CastRays", READ),
    ("clearance.v1.Queries", "CastShapes", READ),
    ("clearance.v1.Queries", "CheckMovingPairs", READ),
    ("clearance.v1.Queries", "Overlap", READ),
    ("clearance.v1.Queries", "NearestBodies", READ),
    ("clearance.v1.Queries", "WatchContacts", READ),
    ("clearance.v1.Queries", "CheckMotions", READ),
    ("clearance.v1.Queries", "CheckPath", READ),
    ("clearance.v1.Queries", "Clearance", READ),
    ("clearance.v1.Queries", "Estimate", READ),
    ("clearance.v1.Queries", "QueryStream", READ),
    ("clearance.v1.Server", "GetServerInfo", READ),
    // Probes have no token.
    ("grpc.health.v1.Health", "Check", OPEN),
    ("grpc.health.v1.Health", "Watch", OPEN),
    ("grpc.reflection.v1.ServerReflection", "ServerReflectionInfo", READ),
    ("grpc.reflection.v1alpha.ServerReflection", "ServerReflectionInfo", READ),
];

/// What a call of this path (`/SERVICE/METHOD`) needs. A path that nothing is served at is for readers, who are told so.
pub(super) fn need(path: &str) -> Need {
    let call = path.strip_prefix('/').and_then(|call| call.split_once('/'));
    let row = TABLE.iter().find(|(service, method, _)| call == Some((service, method)));
    row.map_or(READ, |(_, _, need)| *need)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use tonic_health::pb::FILE_DESCRIPTOR_SET as HEALTH;

    use super::*;
    use crate::transports::wire::descriptors::methods;
    use crate::transports::wire::v1::DESCRIPTORS;

    #[test]
    fn every_rpc_that_is_served_has_its_row_and_no_row_is_stale() {
        use tonic_reflection::pb::{v1, v1alpha};
        let mut served = BTreeSet::new();
        for descriptors in [DESCRIPTORS, HEALTH, v1::FILE_DESCRIPTOR_SET, v1alpha::FILE_DESCRIPTOR_SET] {
            served.extend(methods(descriptors).map(|method| (method.service, method.method)));
        }
        let listed: BTreeSet<_> = TABLE.iter().map(|(s, m, _)| ((*s).to_owned(), (*m).to_owned())).collect();
        assert_eq!(listed.len(), TABLE.len(), "a row stands twice");
        assert_eq!(served, listed);
    }

    #[test]
    fn what_changes_something_needs_write_and_what_is_unknown_is_not_open() {
        assert_eq!(need("/clearance.v1.Scenes/Apply"), WRITE);
        assert_eq!(need("/clearance.v1.Queries/Collide"), READ);
        assert_eq!(need("/grpc.health.v1.Health/Check"), OPEN);
        for unknown in ["", "/", "/clearance.v1.Scenes", "/clearance.v1.Scenes/Apply/", "clearance.v1.Scenes/Apply"] {
            assert_eq!(need(unknown), READ, "{unknown:?}");
        }
    }
}
