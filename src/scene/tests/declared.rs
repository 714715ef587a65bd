//! Declared effects: which declaration decides, what margins have to do with them, and whom they speak of.

use super::*;

fn of(effects: &[Effect]) -> Option<Effects> {
    Some(effects.iter().copied().collect())
}

fn declared(scene: &Scene, a: &str, b: &str) -> Option<Effects> {
    let snapshot = scene.snapshot();
    let [a, b] = [a, b].map(|name| snapshot.body_named(name).unwrap().member());
    assert_eq!(snapshot.declared(a, b), snapshot.declared(b, a));
    snapshot.declared(a, b)
}

#[test]
fn the_most_specific_declaration_decides_and_equals_add_up() {
    let mut scene = scene_of([grouped("a", &["g", "k"]), grouped("b", &["h"])]);
    assert!(declared(&scene, "a", "b").is_none() && !scene.snapshot().declares_effects());
    apply(&mut scene, &[declare(Party::Everything, Party::Everything, Some(Effects::NONE))]);
    assert!(!admits(&scene, "a", "b"), "a closed scene");
    apply(&mut scene, &[declare(group("g"), group("h"), of(&[Effect::Distance]))]);
    apply(&mut scene, &[declare(group("h"), group("k"), of(&[Effect::Motion]))]);
    assert!(admits(&scene, "a", "b"));
    assert_eq!(declared(&scene, "a", "b"), of(&[Effect::Distance, Effect::Motion]));
    apply(&mut scene, &[declare(one("a"), one("b"), Some(Effects::NONE))]);
    assert!(!admits(&scene, "a", "b"));
    apply(&mut scene, &[declare(one("b"), one("a"), None)]);
    assert!(admits(&scene, "a", "b"));
}

#[test]
fn a_margin_above_zero_needs_the_effect_whichever_comes_first() {
    let mut scene = scene_of([grouped("a", &["g"]), grouped("b", &["h"])]);
    let refused = |scene: &mut Scene, edits: &[Edit]| match scene.apply(edits, None).unwrap_err() {
        Refusal::Edit { index, field, reason } => format!("{index} {field}: {reason}"),
        other @ (Refusal::RevisionMismatch { .. } | Refusal::TooManyEdits(_)) => panic!("{other:?}"),
    };
    let without = declare(group("g"), group("h"), of(&[Effect::Patch]));
    let entered = margin(group("h"), group("g"), Some(0.1));
    let expected =
        r#"the pair of group "h" and group "g" is declared without the effect `margin`, and has a margin of 0.1 m"#;
    assert_eq!(refused(&mut scene, &[without.clone(), entered.clone()]), format!("1 margin: {expected}"));
    let turned =
        r#"the pair of group "g" and group "h" is declared without the effect `margin`, and has a margin of 0.1 m"#;
    assert_eq!(refused(&mut scene, &[entered.clone(), without.clone()]), format!("1 effects: {turned}"));
    assert!(!scene.snapshot().declares_effects() && scene.snapshot().largest_margin() == 0.0);
    // No margin is none, and one that is declared may be entered.
    apply(&mut scene, &[without, margin(group("g"), group("h"), Some(0.0))]);
    apply(&mut scene, &[declare(group("g"), group("h"), of(&[Effect::Margin])), entered]);
    assert_eq!(scene.snapshot().largest_margin(), 0.1);
}

#[test]
fn declarations_go_with_whom_they_name_and_keep_groups_in_use() {
    let model = arm();
    let mut scene = scene_of([ball("a", 0.0)]);
    let robot = || Party::Robot("arm".to_owned());
    apply(
        &mut scene,
        &[
            add_arm("arm", &model),
            declare(robot(), robot(), Some(Effects::NONE)),
            declare(one("a"), group("later"), of(&[Effect::Events])),
        ],
    );
    assert!(scene.snapshot().robot("arm").unwrap().self_pairs.is_empty());
    assert!(scene.snapshot().has_group("later"));
    let entries = scene.snapshot().pair_entries();
    let told: Vec<_> = entries.iter().map(|entry| (entry.allowed, entry.margin, entry.effects)).collect();
    assert_eq!(told, [(None, None, of(&[Effect::Events])), (None, None, Some(Effects::NONE))]);
    apply(&mut scene, &[Edit::RemoveBody { body: "a".into() }, Edit::RemoveRobot { robot: "arm".to_owned() }]);
    assert!(!scene.snapshot().has_group("later") && !scene.snapshot().declares_effects());
    apply(&mut scene, &[add_arm("arm", &model)]);
    assert_eq!(*scene.snapshot().robot("arm").unwrap().self_pairs, [(0, 2)]);
}
