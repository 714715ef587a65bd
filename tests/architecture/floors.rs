//! Do imports go downward only? The table of floors, the table of outside crates, and the check of a file against both.

use crate::source::{NamedPath, Source};

/// A top-level module and what it may name of the others.
pub struct Floor {
    /// The module.
    pub name: &'static str,
    /// Modules, or single items of them, that it may name.
    pub may_name: &'static [&'static str],
    /// Items of those that it must not know all the same.
    pub but_not: &'static [&'static str],
}

const GEOMETRY: &str = "geometry";
/// Outcomes of the narrow phase that stand in answers: plain values, known wherever answers are.
const BRACKET: &str = "narrow_phase::Bracket";
const COST: &str = "narrow_phase::Cost";
const TERMINATION: &str = "narrow_phase::Termination";
const PATCH: &str = "narrow_phase::ContactPatch";
const PATCH_POINT: &str = "narrow_phase::ContactPoint";
/// Derivatives, and how they are asked for.
const DERIVATIVES: &str = "narrow_phase::Derivatives";
const DERIVATIVE_COST: &str = "narrow_phase::DerivativeCost";
const DERIVATIVE_GOAL: &str = "narrow_phase::DerivativeGoal";
const DERIVATIVE_METHOD: &str = "narrow_phase::DerivativeMethod";
const TWIST_MATRIX: &str = "narrow_phase::TwistMatrix";
/// The choice of a solver stands in questions: a plain value too.
const SOLVER: &str = "narrow_phase::Solver";
/// The world that changes. Only `scene` and `service` know it; everybody else sees snapshots.
const WRITER: &str = "scene::Scene";
/// Generated protobuf types.
const PROTOBUF: &str = "transports::wire";

/// From the ground up. What stands at the top may name everything.
pub const FLOORS: &[Floor] = &[
    Floor { name: GEOMETRY, may_name: &[], but_not: &[] },
    Floor { name: "limits", may_name: &[], but_not: &[] },
    Floor { name: "narrow_phase", may_name: &[GEOMETRY], but_not: &[] },
    Floor {
        name: "broad_phase",
        may_name: &[
            "geometry::Aabb",
            "geometry::BoxCast",
            "geometry::Mat3",
            "geometry::OrientedBox",
            "geometry::Vec3",
            "geometry::Pose",
            "geometry::Placement",
        ],
        but_not: &[],
    },
    Floor { name: "robot", may_name: &[GEOMETRY], but_not: &[] },
    Floor { name: "scene", may_name: &[GEOMETRY, "limits", "narrow_phase", "broad_phase", "robot"], but_not: &[] },
    Floor {
        name: "query",
        may_name: &[GEOMETRY, "limits", "narrow_phase", "broad_phase", "robot", "scene"],
        but_not: &[WRITER],
    },
    Floor {
        name: "service",
        may_name: &[GEOMETRY, "limits", "robot", "scene", "query", BRACKET, COST, TERMINATION],
        but_not: &[],
    },
    Floor {
        name: "transports",
        may_name: &[
            GEOMETRY,
            "limits",
            "robot",
            "scene",
            "query",
            "service",
            BRACKET,
            COST,
            TERMINATION,
            PATCH,
            PATCH_POINT,
            DERIVATIVES,
            DERIVATIVE_COST,
            DERIVATIVE_GOAL,
            DERIVATIVE_METHOD,
            TWIST_MATRIX,
            SOLVER,
        ],
        but_not: &[WRITER],
    },
    Floor {
        name: "study",
        may_name: &[GEOMETRY, "limits", "narrow_phase", "broad_phase", "robot", "scene", "query", "service"],
        but_not: &[],
    },
    Floor { name: "observability", may_name: &["limits", "scene", "query", "service", COST], but_not: &[WRITER] },
    Floor { name: "app", may_name: &["*"], but_not: &[WRITER, PROTOBUF] },
    Floor { name: "cli", may_name: &["*"], but_not: &[WRITER, PROTOBUF] },
    Floor { name: "main", may_name: &["*"], but_not: &[WRITER, PROTOBUF] },
];

/// The floors below `service`: no threads, clocks, files or network, and nothing async.
pub const KERNEL: &[&str] = &[GEOMETRY, "limits", "narrow_phase", "broad_phase", "robot", "scene", "query"];

/// Who may name which crate of `Cargo.toml`. A new dependency needs a line here before it builds into the house.
pub const CRATES: &[(&str, &[&str])] = &[
    ("arc-swap", &["service"]),
    ("arrayvec", &[GEOMETRY, "narrow_phase", "broad_phase"]),
    ("base64", &[GEOMETRY]),
    ("clap", &["app", "cli", "main"]),
    ("clarabel", &["narrow_phase"]),
    ("dashu-int", &["narrow_phase"]),
    ("http", &["transports"]),
    ("http-body", &["transports"]),
    ("http-body-util", &["observability"]),
    ("hyper", &["observability"]),
    ("hyper-util", &["observability"]),
    ("iceoryx2", &["transports"]),
    ("indicatif", &["cli"]),
    ("libm", &[GEOMETRY, "limits", "narrow_phase", "broad_phase", "robot", "scene", "query", "study"]),
    ("nalgebra", &[GEOMETRY, "limits", "narrow_phase", "broad_phase", "robot", "scene", "query", "study"]),
    ("opentelemetry", &["observability"]),
    ("opentelemetry-otlp", &["observability"]),
    ("opentelemetry_sdk", &["observability"]),
    ("parry3d-f64", &[GEOMETRY]),
    ("percent-encoding", &["transports"]),
    ("procfs", &["observability"]),
    ("prometheus-client", &["observability", "app"]),
    ("prost", &["transports"]),
    ("pulp", &[GEOMETRY]),
    ("rayon", &["service"]),
    ("robust", &[GEOMETRY, "narrow_phase"]),
    ("roxmltree", &[GEOMETRY, "robot"]),
    ("rpds", &["scene"]),
    ("rustix", &["transports", "cli"]),
    ("sd-notify", &["app"]),
    ("serde", &[GEOMETRY, "limits", "app", "cli"]),
    ("serde_json", &[GEOMETRY, "transports", "study", "app", "cli"]),
    ("sha2", &["service", "transports"]),
    ("subtle", &["transports"]),
    ("thiserror", &["*"]),
    ("tokio", &["service", "study", "observability", "transports", "app", "cli", "main"]),
    ("tokio-rustls", &["transports"]),
    ("tokio-stream", &["transports"]),
    ("toml", &["app"]),
    ("tonic", &["transports"]),
    ("tonic-health", &["transports"]),
    ("tonic-prost", &["transports"]),
    ("tonic-reflection", &["transports"]),
    ("tonic-web", &["transports"]),
    ("tower", &["transports"]),
    ("tower-http", &["transports"]),
    ("tracing", &["service", "observability", "transports", "app", "cli", "main"]),
    ("tracing-opentelemetry", &["observability"]),
    ("tracing-subscriber", &["observability", "app", "cli", "main"]),
    ("wide", &["broad_phase"]),
    ("x509-parser", &["transports"]),
    ("zenoh", &["transports"]),
    ("zenoh-ext", &["transports"]),
];

/// What is wrong with the imports of `source`, one line each.
pub fn check(source: &Source) -> Vec<String> {
    let Some(name) = source.module.first() else { return Vec::new() };
    let Some(floor) = FLOORS.iter().find(|floor| floor.name == name) else {
        return vec![format!("{}: `{name}` is on no floor", source.file)];
    };
    source.paths.iter().filter_map(|path| fault(path, floor, &source.file)).collect()
}

fn fault(path: &NamedPath, floor: &Floor, file: &str) -> Option<String> {
    let names = path.names.join("::");
    let place = format!("{file}:{}", path.line);
    if path.own {
        let stays = path.names.first().is_none_or(|first| first == floor.name);
        let allowed = floor.may_name.iter().any(|entry| covers(entry, &path.names));
        let banned = floor.but_not.iter().any(|entry| covers(entry, &path.names));
        let wrong = !stays && (!allowed || banned);
        return wrong.then(|| format!("{place}: `{}` must not know `{names}`", floor.name));
    }
    let (krate, users) = CRATES.iter().find(|(krate, _)| krate.replace('-', "_") == path.names[0])?;
    let wrong = !users.contains(&"*") && !users.contains(&floor.name);
    wrong.then(|| format!("{place}: `{}` must not use the crate `{krate}`: `{names}`", floor.name))
}

/// Whether `names` is the item `entry` or something in it.
fn covers(entry: &str, names: &[String]) -> bool {
    entry == "*" || (entry.split("::").count() <= names.len() && entry.split("::").zip(names).all(|(e, n)| e == n))
}

/// What is wrong with the dependencies of `manifest`, one line each: every crate has its line in [`CRATES`], and those of
/// one door alone are optional, so that the kernel builds without it.
pub fn check_manifest(manifest: &toml::Table) -> Vec<String> {
    let mut faults = Vec::new();
    let empty = toml::Table::new();
    let dependencies = manifest.get("dependencies").and_then(toml::Value::as_table).unwrap_or(&empty);
    for (name, value) in dependencies {
        let Some((_, users)) = CRATES.iter().find(|(krate, _)| krate == name) else {
            faults.push(format!(
                "Cargo.toml: `{name}` has no line in the table of crates (tests/architecture/floors.rs)"
            ));
            continue;
        };
        let optional = value.get("optional").and_then(toml::Value::as_bool).unwrap_or(false);
        if *users == ["transports"] && !optional {
            faults.push(format!("Cargo.toml: `{name}` serves a door alone and must be optional"));
        }
    }
    let stale = CRATES.iter().filter(|(krate, _)| !dependencies.contains_key(*krate));
    faults.extend(stale.map(|(krate, _)| format!("`{krate}` is in the table of crates, but not in Cargo.toml")));
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(file: &str, text: &str) -> usize {
        check(&Source::parse(file, text).unwrap()).len()
    }

    #[test]
    fn downward_imports_pass_and_upward_ones_do_not() {
        assert_eq!(faults("src/query/a.rs", "use crate::{geometry::Pose, scene::Snapshot};"), 0);
        assert_eq!(faults("src/scene/a.rs", "use crate::query::Answer;"), 1);
        assert_eq!(faults("src/geometry/a.rs", "use super::super::scene::BodyId;"), 1);
        assert_eq!(faults("src/geometry/a.rs", "use crate::*;"), 1);
        assert_eq!(faults("src/cli/a.rs", "use crate::{app, query, transports::grpc};"), 0);
    }

    #[test]
    fn siblings_do_not_see_each_other() {
        assert_eq!(faults("src/narrow_phase/a.rs", "use crate::broad_phase::DynamicTree;"), 1);
        assert_eq!(faults("src/broad_phase/a.rs", "use crate::geometry::{Aabb, Shape};"), 1);
        assert_eq!(faults("src/robot/a.rs", "fn f() { crate::narrow_phase::separation(); }"), 1);
    }

    #[test]
    fn transports_know_outcomes_but_neither_the_solver_nor_the_writer() {
        assert_eq!(faults("src/transports/wire/a.rs", "use crate::narrow_phase::{Bracket, Termination};"), 0);
        assert_eq!(faults("src/transports/wire/a.rs", "use crate::narrow_phase::separation;"), 1);
        assert_eq!(faults("src/transports/wire/a.rs", "use crate::scene::{Scene, Snapshot};"), 1);
        assert_eq!(faults("src/service/a.rs", "use crate::scene::Scene;"), 0);
        assert_eq!(faults("src/query/a.rs", "use crate::scene::Scene;"), 1);
    }

    #[test]
    fn protobuf_and_its_crates_stay_in_transports() {
        assert_eq!(faults("src/transports/grpc/a.rs", "use tonic::Status; use prost::Message;"), 0);
        assert_eq!(faults("src/service/a.rs", "fn f() -> Result<(), tonic::Status> {}"), 1);
        assert_eq!(faults("src/app/a.rs", "use crate::transports::wire::to_proto;"), 1);
        assert_eq!(faults("src/query/a.rs", "fn f() { rayon::join(|| 1, || 2); }"), 1);
    }

    #[test]
    fn a_module_without_a_floor_is_found() {
        assert_eq!(faults("src/toolbox.rs", "fn f() {}"), 1);
        assert_eq!(faults("src/lib.rs", "pub mod geometry;"), 0);
    }

    #[test]
    fn unknown_and_compulsory_door_crates_are_found_in_the_manifest() {
        let listed = |line: &str| {
            let others: String = CRATES.iter().map(|(krate, _)| format!("{krate} = {{ optional = true }}\n")).collect();
            check_manifest(&format!("[dependencies]\n{others}{line}").parse().unwrap())
        };
        assert_eq!(listed(""), Vec::<String>::new());
        assert_eq!(listed("leftpad = \"1\"").len(), 1);
        let manifest = "[dependencies]\ntonic = \"0.14\"".parse().unwrap();
        assert!(check_manifest(&manifest).iter().any(|fault| fault.contains("must be optional")));
        assert!(check_manifest(&manifest).iter().any(|fault| fault.contains("not in Cargo.toml")));
    }
}
