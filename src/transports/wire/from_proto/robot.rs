//! Robots: from messages to what a model is loaded from.

use std::collections::BTreeMap;

use super::{Path, geometry};
use crate::robot::{LinkOptions, LinkOverride, ModelOptions};
use crate::service::{ContentHash, RobotDescription, ServiceError};
use crate::transports::wire::v1;

/// A robot's description.
///
/// # Errors
/// A hash that is none, a file or link that is named twice, a mode that is unknown.
pub fn robot_description(request: v1::LoadRobotRequest) -> Result<RobotDescription, ServiceError> {
    let mut meshes = BTreeMap::new();
    for (index, binding) in request.meshes.iter().enumerate() {
        let path = Path::root_item("meshes", index);
        let hash: ContentHash = binding.sha256.parse().map_err(|error| path.field("sha256").invalid(error))?;
        if meshes.insert(binding.filename.clone(), hash).is_some() {
            return Err(path.field("filename").invalid(format!("{:?} is there twice", binding.filename)));
        }
    }
    let mut links = BTreeMap::new();
    for (index, own) in request.links.iter().enumerate() {
        let path = Path::root_item("links", index);
        let mesh = geometry::mesh_mode(&path.field("mesh_mode"), own.mesh_mode)?;
        for (field, number) in [("scale", own.scale), ("padding", own.padding)] {
            length(&path.field(field), number.unwrap_or(0.0))?;
        }
        let choices = LinkOverride { mesh, scale: own.scale, padding: own.padding };
        if links.insert(own.link.clone(), choices).is_some() {
            return Err(path.field("link").invalid(format!("{:?} is there twice", own.link)));
        }
    }
    let mesh = geometry::mesh_mode(&Path::root("mesh_mode"), request.mesh_mode)?.unwrap_or_default();
    let scale = length(&Path::root("scale"), request.scale.unwrap_or(1.0))?;
    let padding = length(&Path::root("padding"), request.padding)?;
    let options = ModelOptions { all: LinkOptions { mesh, scale, padding }, links };
    Ok(RobotDescription { urdf: request.urdf, srdf: request.srdf, meshes, options })
}

/// A number that a length can be multiplied or grown by.
fn length(path: &Path<'_>, number: f64) -> Result<f64, ServiceError> {
    if !number.is_finite() {
        return Err(path.invalid("is not finite"));
    }
    if number < 0.0 {
        return Err(path.invalid(format!("is negative: {number}")));
    }
    Ok(number)
}
