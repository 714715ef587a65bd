//! A robot's description on disk: where are the mesh files that its URDF names?
//!
//! The daemon reads no files, so whoever has them resolves names. `package://NAME/rest` is `rest` in the folder that was
//! given for NAME, else in the URDF's own; any other name is a path from the URDF's folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use crate::robot;

/// `--package NAME=DIR`: where a package of the URDF is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Package {
    name: String,
    folder: PathBuf,
}

impl FromStr for Package {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, folder) = text.split_once('=').ok_or("needs the form NAME=DIR")?;
        if name.is_empty() || folder.is_empty() {
            return Err("needs the form NAME=DIR".to_owned());
        }
        Ok(Self { name: name.to_owned(), folder: folder.into() })
    }
}

/// The texts of a description and the bytes of every mesh file it names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RobotFiles {
    /// The text of the URDF.
    pub urdf: String,
    /// The text of the SRDF, if there is one.
    pub srdf: Option<String>,
    /// Mesh files by the names that the URDF has for them.
    pub meshes: BTreeMap<String, Vec<u8>>,
}

impl RobotFiles {
    /// Reads everything that belongs to the robot.
    ///
    /// # Errors
    /// A file that cannot be read, with the name the URDF has for it, or a URDF that makes no sense.
    pub fn read(urdf_path: &Path, srdf_path: Option<&Path>, packages: &[Package]) -> Result<Self, String> {
        let urdf = read_text(urdf_path)?;
        let srdf = srdf_path.map(read_text).transpose()?;
        let folder = urdf_path.parent().unwrap_or(Path::new(""));
        let files = robot::mesh_files(&urdf).map_err(|error| format!("{}: {error}", urdf_path.display()))?;
        let mut meshes = BTreeMap::new();
        for name in files {
            let path = resolve(&name, folder, packages);
            let bytes = fs::read(&path)
                .map_err(|error| format!("{}: mesh {name:?} at {}: {error}", urdf_path.display(), path.display()))?;
            meshes.insert(name, bytes);
        }
        Ok(Self { urdf, srdf, meshes })
    }
}

/// A text file, with its name in what went wrong.
///
/// # Errors
/// It cannot be read, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn resolve(name: &str, urdf_folder: &Path, packages: &[Package]) -> PathBuf {
    if let Some((package, rest)) = name.strip_prefix("package://").and_then(|name| name.split_once('/')) {
        let given = packages.iter().find(|given| given.name == package);
        return given.map_or(urdf_folder, |given| &given.folder).join(rest);
    }
    urdf_folder.join(name.strip_prefix("file://").unwrap_or(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_the_urdfs_folder_unless_said_otherwise() {
        let packages = ["arm=/robots/arm".parse().unwrap(), "hand=../hand".parse().unwrap()];
        let folder = Path::new("/here");
        for (name, path) in [
            ("package://arm/meshes/a.obj", "/robots/arm/meshes/a.obj"),
            ("package://hand/a.stl", "../hand/a.stl"),
            ("package://other/meshes/a.obj", "/here/meshes/a.obj"),
            ("meshes/a.obj", "/here/meshes/a.obj"),
            ("file:///meshes/a.obj", "/meshes/a.obj"),
            ("/meshes/a.obj", "/meshes/a.obj"),
        ] {
            assert_eq!(resolve(name, folder, &packages), Path::new(path), "{name}");
        }
        assert!("arm".parse::<Package>().is_err() && "=x".parse::<Package>().is_err());
    }
}
