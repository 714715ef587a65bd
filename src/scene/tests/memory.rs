//! What revisions write and hold. Oracle: the numbers of nodes and bodies that an edit can touch.

use super::*;
use crate::limits::Limits;

const KINDS: [BroadPhaseKind; 3] = [BroadPhaseKind::Tree, BroadPhaseKind::SweepAndPrune, BroadPhaseKind::Exhaustive];

fn row_of(count: usize, broad_phase: BroadPhaseKind, limits: Limits) -> Scene {
    let mut scene = Scene::with_options(Epoch(1), limits, &SceneOptions { broad_phase });
    let bodies = (0..count).map(|i| Edit::AddBody(ball(&format!("ball {i}"), i as f64)));
    scene.apply(&bodies.collect::<Vec<_>>(), None).unwrap();
    scene
}

fn move_one(scene: &mut Scene, i: u64) -> usize {
    scene.apply(&[Edit::MoveBody { body: BodyId(i).into(), pose: at(i as f64 + 0.1) }], None).unwrap();
    scene.snapshot().written()
}

#[test]
fn an_edit_writes_what_it_changes_however_large_the_scene() {
    for kind in KINDS {
        let written = [1_000, 30_000].map(|count| {
            let mut scene = row_of(count, kind, Limits::default());
            let (built, whole) = (scene.snapshot().written(), scene.snapshot().memory().total());
            assert!(whole / 3 < built && built < 3 * whole, "{kind:?}: wrote {built}, holds {whole}");
            (0..20).map(|i| move_one(&mut scene, 7 + 31 * i)).max().unwrap()
        });
        // Thirty times the bodies: a level or two more in each map, and longer lists of pages.
        assert!(written[1] < 6 * written[0], "{kind:?}: {written:?}");
        assert!(written[0] >= size_of::<Body>() && written[1] < 128 << 10, "{kind:?}: {written:?}");
    }
}

/// Each kept revision had room for as many moves as it was made by, which nobody counted.
#[test]
fn a_revision_keeps_no_room_for_moves() {
    let mut scene = row_of(3000, BroadPhaseKind::Tree, Limits::default());
    let built = scene.snapshot().memory().broad_phase;
    for shift in [0.1, 0.2, 0.3] {
        let place = |i: u64| at(i as f64 + shift);
        let moves = (1..=3000).map(|i| Edit::MoveBody { body: BodyId(i).into(), pose: place(i) });
        scene.apply(&moves.collect::<Vec<_>>(), None).unwrap();
        let moved = scene.snapshot().memory().broad_phase;
        assert!(moved < built + built / 8, "{moved} bytes after moves, {built} before");
    }
}

#[test]
fn revisions_that_hold_too_much_are_let_go_early_and_the_newest_never() {
    for kind in KINDS {
        let limits = Limits { max_kept_bytes: 40_000, ..Limits::default() };
        let mut scene = row_of(500, kind, limits);
        assert_eq!(scene.oldest_revision(), Revision(1), "building it wrote more than may be kept beside");
        for i in 1..200 {
            move_one(&mut scene, i);
            let (oldest, latest) = (scene.oldest_revision(), scene.snapshot().revision());
            let kept: usize = (oldest.0 + 1..=latest.0).map(|r| scene.at(Revision(r)).unwrap().written()).sum();
            assert!(kept <= 40_000, "{kind:?}: {kept}");
            if oldest.0 > 1 {
                assert!(kept + scene.snapshot().written() > 20_000, "{kind:?}: let go too early, {kept} kept");
            }
        }
        let oldest = scene.oldest_revision();
        assert!(oldest > Revision(150), "{kind:?}: {oldest}");
        assert_eq!(scene.at(Revision(3)).unwrap_err(), NotKept::Gone { asked: Revision(3), oldest });
        assert_eq!(scene.at(oldest).unwrap().validate(), Ok(()));
    }
    let mut scene = row_of(50, BroadPhaseKind::Tree, Limits { max_kept_bytes: 0, ..Limits::default() });
    move_one(&mut scene, 3);
    assert_eq!((scene.oldest_revision(), scene.snapshot().revision()), (Revision(2), Revision(2)));
}

#[test]
fn the_largest_margin_is_right_after_it_grew_shrank_and_went() {
    let mut scene = scene_of(["a", "b", "c", "d"].map(|name| ball(name, 0.0)));
    let mut largest = |edit: Edit| {
        apply(&mut scene, &[edit]);
        scene.snapshot().largest_margin()
    };
    assert_eq!(largest(margin(one("a"), one("b"), Some(0.2))), 0.2);
    assert_eq!(largest(margin(one("a"), one("c"), Some(0.5))), 0.5);
    assert_eq!(largest(margin(one("a"), one("c"), Some(0.1))), 0.2);
    assert_eq!(largest(margin(one("c"), group("g"), Some(0.7))), 0.7);
    assert_eq!(largest(margin(one("c"), group("g"), Some(0.9))), 0.9);
    assert_eq!(largest(Edit::RemoveBody { body: "c".into() }), 0.2);
    assert_eq!(largest(margin(one("a"), one("b"), None)), 0.0);
}
