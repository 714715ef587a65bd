//! Which robots were loaded? Models by the hash of everything they were made from, so that loading the same again is
//! the same model.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::ServiceError;
use super::assets::{Assets, ContentHash};
use crate::geometry::mesh_file::{self, MeshFormat};
use crate::limits::{LimitExceeded, Limits};
use crate::robot::{MeshRequest, MeshUse, ModelOptions, RobotModel};

/// What a robot is loaded from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RobotDescription {
    /// The text of the URDF.
    pub urdf: String,
    /// The text of the SRDF.
    pub srdf: Option<String>,
    /// The asset of each mesh file, by the name the URDF has for it.
    pub meshes: BTreeMap<String, ContentHash>,
    /// Mesh modes, scale and padding.
    pub options: ModelOptions,
}

/// A model and the name it goes by.
#[derive(Clone, Debug)]
pub struct LoadedRobot {
    /// The hash of its description, as text.
    pub id: String,
    /// The robot.
    pub model: Arc<RobotModel>,
}

/// The robot models of the daemon.
#[derive(Debug)]
pub struct Robots {
    limits: Limits,
    by_id: Mutex<BTreeMap<String, Arc<RobotModel>>>,
}

impl Robots {
    /// None yet.
    #[must_use]
    pub fn new(limits: &Limits) -> Self {
        Self { limits: limits.clone(), by_id: Mutex::default() }
    }

    /// Makes a model, or finds the one that was made before. Reads meshes, which takes milliseconds to seconds.
    ///
    /// # Errors
    /// A cap, or a description that makes no robot.
    pub fn load(&self, description: &RobotDescription, assets: &Assets) -> Result<LoadedRobot, ServiceError> {
        let RobotDescription { urdf, srdf, meshes, options } = description;
        let longest = urdf.len().max(srdf.as_ref().map_or(0, String::len));
        LimitExceeded::check("max_description_bytes", longest, self.limits.max_description_bytes)?;
        let id = id_of(description);
        if let Ok(known) = self.get(&id) {
            return Ok(known);
        }
        let makes_hulls = |mode: Option<MeshUse>| mode == Some(MeshUse::Hull);
        let hulls = makes_hulls(Some(options.all.mesh)) || options.links.values().any(|own| makes_hulls(own.mesh));
        let mut too_large = None;
        let mut bytes_of = |request: &MeshRequest<'_>| {
            let hash = meshes.get(request.filename).ok_or("the request has no asset for it")?;
            let bytes = assets.get(*hash).map_err(|error| error.to_string())?;
            self.check_size(request.filename, &bytes, hulls).map_err(|exceeded| {
                too_large = Some(exceeded);
                exceeded.to_string()
            })?;
            Ok(bytes)
        };
        let model = RobotModel::from_urdf(urdf, srdf.as_deref(), &mut bytes_of, options);
        if let Some(exceeded) = too_large {
            return Err(ServiceError::Limit(exceeded));
        }
        let model = model.map_err(|error| ServiceError::invalid("robot", error))?;
        let mut by_id = self.by_id();
        LimitExceeded::check("max_robot_models", by_id.len() + 1, self.limits.max_robot_models)?;
        let model = Arc::clone(by_id.entry(id.clone()).or_insert_with(|| Arc::new(model)));
        Ok(LoadedRobot { id, model })
    }

    /// Hulls and trees take long to build for large meshes. A file that cannot be read is for the model to refuse.
    fn check_size(&self, filename: &str, bytes: &[u8], hulls: bool) -> Result<(), LimitExceeded> {
        let soup = MeshFormat::from_name(filename).and_then(|format| mesh_file::read(bytes, format));
        let Ok(soup) = soup else { return Ok(()) };
        LimitExceeded::check("max_mesh_triangles", soup.triangles.len(), self.limits.max_mesh_triangles)?;
        let points = if hulls { soup.vertices.len() } else { 0 };
        LimitExceeded::check("max_hull_points", points, self.limits.max_hull_points)
    }

    /// # Errors
    /// It was never loaded.
    pub fn get(&self, id: &str) -> Result<LoadedRobot, ServiceError> {
        let missing = || ServiceError::NotFound { what: "robot model", name: id.to_owned() };
        let model = self.by_id().get(id).cloned().ok_or_else(missing)?;
        Ok(LoadedRobot { id: id.to_owned(), model })
    }

    /// The name a model of this store goes by.
    #[must_use]
    pub fn id_of(&self, model: &Arc<RobotModel>) -> Option<String> {
        self.by_id().iter().find(|(_, known)| Arc::ptr_eq(known, model)).map(|(id, _)| id.clone())
    }

    /// All of them, in the order of their ids.
    #[must_use]
    pub fn list(&self) -> Vec<LoadedRobot> {
        let loaded = |(id, model): (&String, &Arc<RobotModel>)| LoadedRobot { id: id.clone(), model: model.clone() };
        self.by_id().iter().map(loaded).collect()
    }

    /// The map is whole after every statement, so a poisoned lock guards a sound one.
    fn by_id(&self) -> MutexGuard<'_, BTreeMap<String, Arc<RobotModel>>> {
        self.by_id.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Every part goes in with its length before it, so that no two descriptions read the same.
fn id_of(description: &RobotDescription) -> String {
    let RobotDescription { urdf, srdf, meshes, options } = description;
    let mut bytes = Vec::with_capacity(urdf.len() + 1024);
    let mut text = |text: &str| {
        bytes.extend((text.len() as u64).to_le_bytes());
        bytes.extend(text.as_bytes());
    };
    text(urdf);
    text(srdf.as_ref().map_or("without", |_| "with"));
    text(srdf.as_deref().unwrap_or_default());
    for (filename, hash) in meshes {
        text(filename);
        text(&hash.to_string());
    }
    text("options");
    text(&format!("{:?} {:x} {:x}", options.all.mesh, options.all.scale.to_bits(), options.all.padding.to_bits()));
    for (link, own) in &options.links {
        text(link);
        let bits = |number: Option<f64>| number.map(f64::to_bits);
        text(&format!("{:?} {:x?} {:x?}", own.mesh, bits(own.scale), bits(own.padding)));
    }
    ContentHash::of(&bytes).to_string()
}
