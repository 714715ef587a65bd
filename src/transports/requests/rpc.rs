//! Which rpcs are there, whatever door they come through? The one table of their names; a test holds it against the descriptors.

use crate::service::Rpc;

const fn once(service: &'static str, name: &'static str) -> (&'static str, Rpc) {
    (service, Rpc { name, streams: false })
}

const fn stream(service: &'static str, name: &'static str) -> (&'static str, Rpc) {
    (service, Rpc { name, streams: true })
}

/// Services, and their rpcs.
const TABLE: &[(&str, Rpc)] = &[
    once("Scenes", "CreateScene"),
    once("Scenes", "ListScenes"),
    once("Scenes", "GetScene"),
    once("Scenes", "GetSceneHealth"),
    once("Scenes", "DeleteScene"),
    once("Scenes", "Apply"),
    stream("Scenes", "Watch"),
    stream("Scenes", "PoseStream"),
    once("Assets", "HasAssets"),
    once("Assets", "PutAsset"),
    once("Assets", "DescribeMesh"),
    once("Robots", "LoadRobot"),
    once("Robots", "ListRobots"),
    once("Robots", "GetRobot"),
    once("Queries", "CheckStates"),
    once("Queries", "Collide"),
    once("Queries", "Distance"),
    once("Queries", "CastRays"),
    once("Queries", "CastShapes"),
    once("Queries", "CheckMovingPairs"),
    once("Queries", "Overlap"),
    once("Queries", "NearestBodies"),
    stream("Queries", "WatchContacts"),
    once("Queries", "CheckMotions"),
    once("Queries", "CheckPath"),
    once("Queries", "Clearance"),
    once("Queries", "Estimate"),
    stream("Queries", "QueryStream"),
    once("Server", "GetServerInfo"),
];

/// The rpc that is called by `SERVICE/METHOD`, with or without `/` and the package in front.
#[must_use]
pub fn rpc_named(name: &str) -> Option<Rpc> {
    let name = name.strip_prefix('/').unwrap_or(name);
    let (service, method) = name.strip_prefix("clearance.v1.").unwrap_or(name).split_once('/')?;
    TABLE.iter().find(|(of, rpc)| *of == service && rpc.name == method).map(|(_, rpc)| *rpc)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::transports::wire::descriptors::methods;
    use crate::transports::wire::v1::DESCRIPTORS;

    #[test]
    fn every_rpc_has_its_row_and_no_row_is_stale() {
        let mut served = 0;
        for method in methods(DESCRIPTORS) {
            let path = format!("/{}/{}", method.service, method.method);
            let rpc = rpc_named(&path).unwrap_or_else(|| panic!("{path} has no row"));
            assert_eq!((rpc.name, rpc.streams), (method.method.as_str(), method.streams_answers));
            assert_eq!(rpc_named(path.trim_start_matches("/clearance.v1.")), Some(rpc));
            served += 1;
        }
        assert_eq!(served, TABLE.len());
    }

    /// Whoever watches the daemon tells rpcs apart by their methods alone.
    #[test]
    fn no_two_services_have_a_method_of_one_name() {
        let names: BTreeSet<_> = TABLE.iter().map(|(_, rpc)| rpc.name).collect();
        assert_eq!(names.len(), TABLE.len());
    }

    #[test]
    fn what_is_no_rpc_has_no_name() {
        for name in ["", "/", "Queries", "/Queries/", "/grpc.health.v1.Health/Check", "/clearance.v1.Queries/Guess"] {
            assert_eq!(rpc_named(name), None, "{name:?}");
        }
    }
}
