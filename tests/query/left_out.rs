//! A build without the code of an effect refuses what needs it, by name. Oracle: the effect and the field that has to be named.
#![cfg(not(all(feature = "effect-derivatives", feature = "effect-motion", feature = "effect-patch")))]

use clearance::query::{Context, Refused};
use clearance::scene::{Epoch, Scene};

fn not_built(refused: Option<Refused>, field: &'static str, effect: &'static str) {
    assert_eq!(refused, Some(Refused::NotBuilt { field, effect }));
}

#[cfg(not(feature = "effect-motion"))]
#[test]
fn every_question_about_motions_is_refused_by_name() {
    use clearance::query::{
        CastMode, CastShapes, Casts, CheckMotions, CheckMovingPairs, DEFAULT_RESOLUTION, Find, Mode, Motions,
        MovingPairs, Prepared,
    };
    let snapshot = Scene::new(Epoch(1)).snapshot();
    for (motions, field) in [(Motions::Edges, "motions"), (Motions::Path, "waypoints")] {
        let request = CheckMotions {
            robot: "arm".to_owned(),
            positions: vec![0.0, 1.0],
            motions,
            mode: Mode::All,
            find: Find::FirstContact,
            resolution: CheckMotions::DEFAULT_RESOLUTION,
            max_states: CheckMotions::DEFAULT_MAX_STATES,
            context: Context::default(),
        };
        not_built(Prepared::check_motions(&*snapshot, &request).err(), field, "motion");
    }
    let context = Context::default();
    let (mode, resolution) = (CastMode::First, DEFAULT_RESOLUTION);
    let shapes = CastShapes { items: Vec::new(), mode, resolution, context: context.clone() };
    not_built(Casts::new(&snapshot, &shapes).err(), "items", "motion");
    let pairs = CheckMovingPairs { items: Vec::new(), resolution, context };
    not_built(MovingPairs::new(&snapshot, &pairs).err(), "items", "motion");
}

#[cfg(not(feature = "effect-patch"))]
#[test]
fn patches_are_refused_by_name() {
    use clearance::query::{Mode, PairQuery, Prepared, Wants};
    let context = Context { wants: Wants { patch: true, ..Wants::VERDICT }, ..Context::default() };
    let query = PairQuery { items: Vec::new(), mode: Mode::All, context };
    let refused = Prepared::collide(&*Scene::new(Epoch(1)).snapshot(), &query).err();
    not_built(refused, "context.wants", "patch");
}

#[cfg(not(feature = "effect-derivatives"))]
#[test]
fn derivatives_are_refused_by_name() {
    use clearance::query::{Mode, NearestBodies, Neighbours, PairQuery, Prepared, Wants};
    let scene = Scene::new(Epoch(1)).snapshot();
    let context = Context { wants: Wants { derivatives: true, ..Wants::VERDICT }, ..Context::default() };
    let query = PairQuery { items: Vec::new(), mode: Mode::All, context: context.clone() };
    not_built(Prepared::distance(&*scene, &query).err(), "context.wants", "derivatives");
    let near = NearestBodies { items: Vec::new(), count: 1, context };
    not_built(Neighbours::new(&scene, &near).err(), "context.wants", "derivatives");
}
