//! Robots that are wrong, each refused by a text that names the element and the field.

use clearance::geometry::Pose;
use clearance::geometry::tolerance::LARGEST_LENGTH;
use clearance::robot::{LinkOptions, LinkOverride, ModelOptions};
use proptest::prelude::*;

use crate::arm::{ARM, model, model_with};

fn arm_with(from: &str, to: &str) -> String {
    assert!(ARM.contains(from), "{from}");
    model(&ARM.replace(from, to), None).unwrap_err().to_string()
}

fn srdf_error(body: &str) -> String {
    model(ARM, Some(&format!("<robot name=\"arm\">{body}</robot>"))).unwrap_err().to_string()
}

#[test]
fn wrong_urdfs_are_refused_by_name() {
    let box_to = |shape: &str| arm_with(r#"<box size="1 1 1"/>"#, shape);
    let slide_axis = r#"<axis xyz="1 0 0"/>"#;
    let cases = vec![
        (arm_with("<robot", "<robot <"), "URDF is not well-formed XML: invalid name token at 1:8"),
        (model("<sdf/>", None).unwrap_err().to_string(), "URDF begins with <sdf>, not with <robot>"),
        (model("<robot/>", None).unwrap_err().to_string(), "the URDF has no links"),
        (arm_with(r#"<link name="a">"#, "<link>"), "link number 1 has no name"),
        (arm_with(r#"<link name="b">"#, r#"<link name="a">"#), r#"there are two links named "a""#),
        (arm_with(r#"name="slide""#, r#"name="turn""#), r#"there are two joints named "turn""#),
        (
            arm_with(r#"<child link="c"/>"#, r#"<child link="x"/>"#),
            r#"joint "bolt": child names link "x", which does not exist"#,
        ),
        (
            arm_with(r#"<parent link="c"/>"#, r#"<parent link="x"/>"#),
            r#"joint "slide": parent names link "x", which does not exist"#,
        ),
        (arm_with(r#"<child link="c"/>"#, ""), r#"joint "bolt" has no child"#),
        (
            arm_with(r#"<child link="c"/>"#, r#"<child link="b"/>"#),
            r#"link "b" is the child of two joints, "turn" and "bolt""#,
        ),
        (arm_with(r#"<parent link="a"/>"#, r#"<parent link="f"/>"#), r#"link "b" is its own ancestor"#),
        (
            arm_with("</robot>", r#"<link name="z"/></robot>"#),
            r#"there are two root links, "a" and "z": no joint leads to either"#,
        ),
        (arm_with(slide_axis, r#"<axis xyz="0 0 0"/>"#), r#"joint "slide": axis is zero"#),
        (
            arm_with(slide_axis, r#"<axis xyz="1 0 x 0"/>"#),
            r#"joint "slide": xyz is to be three finite numbers, not "1 0 x 0""#,
        ),
        (
            arm_with(slide_axis, r#"<axis xyz="1 nan 0"/>"#),
            r#"joint "slide": xyz is to be three finite numbers, not "1 nan 0""#,
        ),
        (arm_with(r#"type="fixed""#, r#"type="planar""#), r#"joint "bolt": type "planar" is not supported"#),
        (arm_with(r#"type="fixed""#, r#"type="revolute""#), r#"joint "bolt" has no limit"#),
        (arm_with(r#"lower="-1""#, r#"lower="2""#), r#"joint "turn": limit has lower 2 above upper 1"#),
        (arm_with(r#"lower="-1""#, r#"lower="inf""#), r#"joint "turn": lower is to be a finite number, not "inf""#),
        (arm_with(r#"joint="slide""#, r#"joint="x""#), r#"joint "grip": mimic names joint "x", which does not exist"#),
        (
            arm_with(r#"joint="slide""#, r#"joint="grip""#),
            r#"joint "grip" mimics itself, directly or by way of others"#,
        ),
        (
            arm_with(r#"joint="slide""#, r#"joint="bolt""#),
            r#"joint "grip" is to mimic "bolt", but a fixed joint has no single position"#,
        ),
        (
            arm_with(r#"multiplier="-2""#, r#"multiplier="two""#),
            r#"joint "grip": multiplier is to be a finite number, not "two""#,
        ),
        (box_to(r#"<box size="1 -1 1"/>"#), r#"link "a", collision 1: half_extents.y is negative: -0.5"#),
        (box_to(r#"<box size="1 1"/>"#), r#"link "a", collision 1: size is to be three finite numbers, not "1 1""#),
        (box_to(r#"<sphere/>"#), r#"link "a", collision 1 has no radius"#),
        (box_to(r#"<cone radius="1"/>"#), r#"link "a", collision 1: geometry <cone> is not supported"#),
        (box_to(""), r#"link "a", collision 1 has no shape in its geometry"#),
        (
            box_to(r#"<mesh filename="x.obj"/>"#),
            r#"link "a", collision 1: mesh "x.obj" is not available: nobody uploaded x.obj"#,
        ),
        (
            box_to(r#"<mesh filename="cut.stl"/>"#),
            r#"link "a", collision 1: mesh "cut.stl": binary STL needs 684 bytes, but there are 100"#,
        ),
        (
            box_to(r#"<mesh filename="package://cube/cube.obj" scale="1 1"/>"#),
            r#"link "a", collision 1: scale is to be three finite numbers, not "1 1""#,
        ),
        (
            arm_with(r#"<origin xyz="0 0 1"/>"#, r#"<origin rpy="0 0 inf"/>"#),
            r#"link "d", collision 1: rpy is to be three finite numbers, not "0 0 inf""#,
        ),
        (
            arm_with(r#"<origin xyz="0 0 1"/>"#, r#"<origin xyz="1e200 0 0"/>"#),
            r#"link "d", collision 1: origin xyz is beyond 1e152 m: 1e200"#,
        ),
        (
            arm_with(r#"<origin xyz="0 0 1"/>"#, r#"<origin quat_xyzw="0 0 0 0"/>"#),
            r#"link "d", collision 1: quat_xyzw is to be four finite numbers, not all zero, in the place of rpy, not "0 0 0 0""#,
        ),
    ];
    let (found, expected): (Vec<String>, Vec<&str>) = cases.into_iter().unzip();
    assert_eq!(found, expected);
}

#[test]
fn circles_of_links_and_of_mimics_are_refused() {
    let joint = |name: &str, parent: &str, child: &str| {
        format!(r#"<joint name="{name}" type="fixed"><parent link="{parent}"/><child link="{child}"/></joint>"#)
    };
    let links = r#"<link name="a"/><link name="b"/><link name="c"/>"#;
    let whole =
        format!("<robot>{links}{}{}{}</robot>", joint("1", "a", "b"), joint("2", "b", "c"), joint("3", "c", "a"));
    assert_eq!(model(&whole, None).unwrap_err().to_string(), r#"link "a" is its own ancestor"#);
    let apart = format!("<robot>{links}{}{}</robot>", joint("1", "b", "c"), joint("2", "c", "b"));
    assert_eq!(model(&apart, None).unwrap_err().to_string(), r#"link "b" is its own ancestor"#);
    let mimic = ARM.replace(r#"<limit lower="0" upper="0.5"/></joint>"#, r#"<limit/><mimic joint="grip"/></joint>"#);
    let text = model(&mimic, None).unwrap_err().to_string();
    assert_eq!(text, r#"joint "slide" mimics itself, directly or by way of others"#);
}

#[test]
fn text_nested_deeper_than_a_stack_is_read() {
    let deep = 200_000;
    let nested = format!("{}{}</robot>", "<x>".repeat(deep), "</x>".repeat(deep));
    assert!(model(&ARM.replace("</robot>", &nested), None).is_ok());
}

#[test]
fn more_links_than_pairs_can_be_listed_for_are_refused() {
    let links: String = (0..2001).map(|i| format!("<link name=\"{i}\"/>")).collect();
    let text = model(&format!("<robot>{links}</robot>"), None).unwrap_err().to_string();
    assert_eq!(text, "there are 2001 links, 2000 are allowed");
}

#[test]
fn wrong_srdfs_are_refused_by_name() {
    let cases = vec![
        (
            srdf_error(r#"<disable_collisions link1="a" link2="x"/>"#),
            r#"disable_collisions: link2 names link "x", which does not exist"#,
        ),
        (srdf_error(r#"<disable_collisions link1="a"/>"#), "disable_collisions has no link2"),
        (
            srdf_error(r#"<enable_collisions link1="x" link2="a"/>"#),
            r#"enable_collisions: link1 names link "x", which does not exist"#,
        ),
        (
            srdf_error(r#"<disable_default_collisions link="x"/>"#),
            r#"disable_default_collisions: link names link "x", which does not exist"#,
        ),
        (
            srdf_error(r#"<group name="g"><joint name="x"/></group>"#),
            r#"group "g": joint names joint "x", which does not exist"#,
        ),
        (
            srdf_error(r#"<group name="g"><link name="x"/></group>"#),
            r#"group "g": link names link "x", which does not exist"#,
        ),
        (
            srdf_error(r#"<group name="g"><chain base_link="a" tip_link="x"/></group>"#),
            r#"group "g": tip_link names link "x", which does not exist"#,
        ),
        (
            srdf_error(r#"<group name="g"><group name="h"/></group>"#),
            r#"group "g": group names group "h", which does not exist"#,
        ),
        (
            srdf_error(r#"<group name="g"><group name="h"/></group><group name="h"><group name="g"/></group>"#),
            r#"group "g" contains itself, directly or by way of others"#,
        ),
        (srdf_error(r#"<group name="g"/><group name="g"/>"#), r#"there are two groups named "g""#),
        (
            srdf_error(r#"<group_state name="s" group="g"/>"#),
            r#"group_state "s": group names group "g", which does not exist"#,
        ),
        (
            srdf_error(
                r#"<group name="g"/><group_state name="s" group="g"><joint name="turn" value="nan"/></group_state>"#,
            ),
            r#"group_state "s", joint "turn": value is to be finite numbers, not "nan""#,
        ),
        (
            srdf_error(
                r#"<group name="g"/><group_state name="s" group="g"><joint name="turn" value="1 2"/></group_state>"#,
            ),
            r#"group_state "s", joint "turn": value is to be a finite number, not "[1.0, 2.0]""#,
        ),
    ];
    let (found, expected): (Vec<String>, Vec<&str>) = cases.into_iter().unzip();
    assert_eq!(found, expected);
}

#[test]
fn options_for_links_that_are_not_there_are_refused() {
    let mut options = ModelOptions::default();
    options.links.insert("x".to_owned(), LinkOverride::default());
    let text = model_with(ARM, None, &options).unwrap_err().to_string();
    assert_eq!(text, r#"options: links names link "x", which does not exist"#);
    let negative = ModelOptions::uniform(LinkOptions { padding: -0.1, ..LinkOptions::default() });
    let text = model_with(ARM, None, &negative).unwrap_err().to_string();
    assert_eq!(text, r#"link "a", collision 1: swept_radius is negative: -0.1"#);
}

#[test]
fn wrong_positions_are_refused_by_joint_and_index_and_limits_only_reported() {
    let floating = ARM.replace(r#"type="fixed""#, r#"type="floating""#);
    let model = model(&floating, None).unwrap();
    assert_eq!(model.degrees_of_freedom(), 9);
    let check = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut positions = vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        change(&mut positions);
        model.check_positions(&positions).map_err(|e| e.to_string())
    };
    assert_eq!(check(&|_| ()), Ok(()));
    let mimic_beyond = format!("position 8 (joint \"slide\") is beyond reach: {:e}", 0.75 * LARGEST_LENGTH);
    let cases = [
        (check(&|p| p.truncate(8)), "8 joint positions were given, the robot has 9"),
        (check(&|p| p[2] = f64::NAN), r#"position 2 (joint "bolt") is not finite"#),
        (check(&|p| p[8] = f64::INFINITY), r#"position 8 (joint "slide") is not finite"#),
        (check(&|p| p[3] = 1e200), r#"position 3 (joint "bolt") is beyond reach: 1e200"#),
        (check(&|p| p[8] = 1e200), r#"position 8 (joint "slide") is beyond reach: 1e200"#),
        (check(&|p| p[8] = 0.75 * LARGEST_LENGTH), &mimic_beyond),
        (check(&|p| p[7] = 0.0), r#"positions 4 to 7 (joint "bolt") are the zero quaternion"#),
    ];
    for (found, expected) in cases {
        assert_eq!(found, Err(expected.to_owned()));
    }
    let outside: Vec<(usize, usize, f64)> = model
        .positions_outside_limits(&[1.5, 9.0, 9.0, 9.0, 0.0, 0.0, 0.0, 2.0, 0.5])
        .map(|outside| (outside.joint, outside.index, outside.position))
        .collect();
    assert_eq!(outside, [(0, 0, 1.5)]);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    /// Whatever the text: a robot with poses, or an error. Never a panic.
    #[test]
    fn bent_texts_never_panic(
        keep in 0.5..1.3f64,
        edits in prop::collection::vec((any::<prop::sample::Index>(), "[ -~]"), 0..5),
    ) {
        let mut text = ARM.to_owned();
        text.truncate((keep * ARM.len() as f64) as usize);
        for (at, character) in edits {
            let at = at.index(text.len());
            text.replace_range(at..=at, &character);
        }
        if let Ok(model) = model(&text, Some(ARM)) {
            let mut poses = Vec::new();
            let positions = vec![0.25; model.degrees_of_freedom()];
            prop_assert_eq!(model.check_positions(&positions), Ok(()));
            model.link_poses(&positions, &Pose::identity(), &mut poses);
            prop_assert_eq!(poses.len(), model.links().len());
        }
    }
}

#[test]
fn a_slide_whose_origin_and_travel_add_up_beyond_reach_is_refused() {
    let origin = r#"<parent link="c"/><origin xyz="6e151 0 0"/><child link="d"/>"#;
    let far = ARM.replace(r#"<parent link="c"/><child link="d"/>"#, origin);
    let model = model(&far, None).unwrap();
    assert!(model.check_positions(&[0.0, 3e151]).is_ok());
    let refused = model.check_positions(&[0.0, 6e151]).unwrap_err().to_string();
    assert_eq!(refused, r#"position 1 (joint "slide") is beyond reach: 6e151"#);
}
