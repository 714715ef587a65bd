//! A small robot of simple shapes, written out, for tests to bend.

use std::sync::Arc;

use clearance::robot::{MeshRequest, ModelOptions, RobotError, RobotModel};

/// A robot without meshes.
pub fn model(urdf: &str, srdf: Option<&str>) -> Result<RobotModel, RobotError> {
    model_with(urdf, srdf, &ModelOptions::default())
}

/// A robot that may use the cube, or a file that was cut off.
pub fn model_with(urdf: &str, srdf: Option<&str>, options: &ModelOptions) -> Result<RobotModel, RobotError> {
    let mut cube_only = |request: &MeshRequest| -> Result<Arc<[u8]>, String> {
        match request.filename {
            "package://cube/cube.obj" => Ok(Arc::from(include_bytes!("../data/meshes/cube.obj").as_slice())),
            "cut.stl" => Ok(Arc::from(&include_bytes!("../data/meshes/cube_binary.stl")[..100])),
            name => Err(format!("nobody uploaded {name}")),
        }
    };
    RobotModel::from_urdf(urdf, srdf, &mut cube_only, options)
}

/// Four links with shapes in a row: a - revolute - b - fixed - c - prismatic - d, and finger f hanging from d by a mimic.
pub const ARM: &str = r#"<robot name="arm">
  <link name="a"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
  <link name="b"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
  <link name="c"><collision><geometry><cylinder radius="0.1" length="2"/></geometry></collision></link>
  <link name="d"><collision><origin xyz="0 0 1"/><geometry><capsule radius="0.1" length="2"/></geometry></collision></link>
  <link name="f"><collision><geometry><sphere radius="0.2"/></geometry></collision></link>
  <joint name="turn" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 2"/><limit lower="-1" upper="1"/></joint>
  <joint name="bolt" type="fixed"><parent link="b"/><child link="c"/></joint>
  <joint name="slide" type="prismatic"><parent link="c"/><child link="d"/><axis xyz="1 0 0"/><limit lower="0" upper="0.5"/></joint>
  <joint name="grip" type="prismatic"><parent link="d"/><child link="f"/><axis xyz="0 1 0"/><limit lower="0" upper="0.5"/><mimic joint="slide" multiplier="-2" offset="0.25"/></joint>
</robot>"#;
