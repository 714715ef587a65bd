//! What becomes of a right robot: mimics, shapes, pairs that are left out, groups, meshes.

use std::sync::Arc;

use clearance::geometry::{Pose, Vec3};
use clearance::robot::{Exclusion, LinkOptions, MeshRequest, MeshUse, ModelOptions, RobotModel};

use crate::arm::{ARM, model};

#[test]
fn a_mimic_follows_and_shapes_stand_where_the_urdf_puts_them() {
    let model = model(ARM, None).unwrap();
    assert_eq!(model.degrees_of_freedom(), 2);
    let mut poses = Vec::new();
    model.link_poses(&[0.0, 0.5], &Pose::identity(), &mut poses);
    let at = |link: &str| poses[model.link(link).unwrap() as usize].translation();
    assert_eq!(at("d"), Vec3::new(0.5, 0.0, 0.0));
    assert_eq!(at("f"), Vec3::new(0.5, -0.75, 0.0));
    let capsule = &model.links()[model.link("d").unwrap() as usize].shapes[0];
    assert_eq!(capsule.pose.translation(), Vec3::new(0.0, 0.0, 1.0));
    assert_eq!((capsule.shape.kind(), capsule.shape.swept_radius()), ("capsule", 0.1));
}

/// Pairs that are left out, by name, with their reasons.
fn excluded(model: &RobotModel) -> Vec<(String, Exclusion)> {
    let name = |link: u32| model.links()[link as usize].name.clone();
    let pair = |(a, b)| format!("{}{}", name(a), name(b));
    model.excluded_pairs().iter().map(|excluded| (pair(excluded.links), excluded.reason.clone())).collect()
}

#[test]
fn without_an_srdf_neighbours_are_left_out_through_fixed_joints_too() {
    let model = model(ARM, None).unwrap();
    let expected = [
        ("ab", Exclusion::Adjacent),
        ("ac", Exclusion::AdjacentBodies),
        ("bc", Exclusion::Adjacent),
        ("bd", Exclusion::AdjacentBodies),
        ("cd", Exclusion::Adjacent),
        ("df", Exclusion::Adjacent),
    ];
    assert_eq!(excluded(&model), expected.map(|(pair, reason)| (pair.to_owned(), reason)));
    assert_eq!(model.self_pairs().len(), 4);
}

#[test]
fn an_srdf_decides_for_all_but_direct_neighbours_and_may_enable_those() {
    let srdf = r#"<robot name="arm">
        <disable_default_collisions link="f"/>
        <enable_collisions link1="f" link2="a"/>
        <enable_collisions link1="c" link2="d"/>
        <enable_collisions link1="b" link2="d"/>
        <disable_collisions link1="d" link2="b" reason="Never"/>
    </robot>"#;
    let model = model(ARM, Some(srdf)).unwrap();
    let quiet = || Exclusion::SrdfDefault { link: "f".to_owned() };
    let expected = [
        ("ab", Exclusion::Adjacent),
        ("bc", Exclusion::Adjacent),
        ("bd", Exclusion::Srdf("Never".to_owned())),
        ("bf", quiet()),
        ("cf", quiet()),
        ("df", quiet()),
    ];
    assert_eq!(excluded(&model), expected.map(|(pair, reason)| (pair.to_owned(), reason)));
    assert_eq!(model.self_pairs(), [(0, 2), (0, 3), (0, 4), (2, 3)]);
}

#[test]
fn groups_gather_joints_links_chains_and_subgroups() {
    let srdf = r#"<robot name="arm">
        <virtual_joint name="floor" type="fixed" parent_frame="world" child_link="a"/>
        <group name="all"><group name="hand"/><joint name="turn"/><joint name="floor"/></group>
        <group name="hand"><chain base_link="c" tip_link="f"/></group>
        <group name="last"><link name="d"/></group>
        <group_state name="open" group="hand">
            <joint name="slide" value="0.5"/><joint name="grip" value="0.1"/><joint name="floor" value=""/>
        </group_state>
    </robot>"#;
    let model = model(ARM, Some(srdf)).unwrap();
    let group = |name: &str| model.group(name).map(|group| (group.joints.clone(), group.links.clone()));
    assert_eq!(group("all"), Some((vec![0, 1], vec![1, 3, 4])));
    assert_eq!(group("hand"), Some((vec![1], vec![3, 4])));
    assert_eq!(group("last"), Some((vec![1], vec![3])));
    assert_eq!(group("none"), None);
    let open = &model.group_states()[0];
    assert_eq!((open.group, open.positions.as_slice()), (1, [(1, vec![0.5])].as_slice()));
}

#[test]
fn meshes_are_fetched_once_scaled_per_axis_and_shared() {
    let mesh = r#"<mesh filename="package://cube/cube.obj" scale="2 1 -1"/>"#;
    let urdf = ARM.replace(r#"<box size="1 1 1"/>"#, mesh).replace(r#"<sphere radius="0.2"/>"#, mesh);
    let mut asked = 0;
    let mut resolver = |request: &MeshRequest| -> Result<Arc<[u8]>, String> {
        asked += 1;
        assert_eq!((request.filename, request.link), ("package://cube/cube.obj", "a"));
        Ok(Arc::from(include_bytes!("../data/meshes/cube.obj").as_slice()))
    };
    let solid = LinkOptions { mesh: MeshUse::Solid, scale: 2.0, padding: 0.125 };
    let model = RobotModel::from_urdf(&urdf, None, &mut resolver, &ModelOptions::uniform(solid)).unwrap();
    assert_eq!(asked, 1);
    let shape = |link: usize| &model.links()[link].shapes[0].shape;
    assert!(Arc::ptr_eq(shape(0), shape(4)));
    // x: -0.25..0.25, times 2, times 2, padded; z: 0.125..0.625, mirrored, times 2, padded.
    let bounds = shape(0).bounds().unwrap();
    assert_eq!((bounds.min.x, bounds.max.x), (-1.125, 1.125));
    assert_eq!((bounds.min.z, bounds.max.z), (-1.375, -0.125));
    // Scale is about the shape's own origin: the capsule's place in its link stays.
    assert_eq!(model.links()[3].shapes[0].pose.translation(), Vec3::new(0.0, 0.0, 1.0));
}
