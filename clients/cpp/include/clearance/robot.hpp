/// Robots: descriptions on this machine's disk, models in the daemon.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "clearance/v1/robot.pb.h"

namespace clearance {

/// What a robot is loaded from.
struct RobotDescription {
  std::string urdf;
  /// Without one only adjacent links may touch.
  std::optional<std::string> srdf;
  /// Bytes of mesh files, by the names that the URDF has for them.
  std::map<std::string, std::string> meshes;
  /// What meshes stand for.
  v1::MeshMode mesh_mode = v1::MESH_MODE_HULL;
  /// Every shape is scaled, then grown by `padding` metres.
  double scale = 1.0;
  double padding = 0.0;
  /// Choices for single links.
  std::vector<v1::LinkOptions> links;

  /// Reads the texts and every mesh file that a collision shape names. `package://NAME/rest` is `rest` in `packages[NAME]`, else in
  /// the URDF's own folder; any other name is a path from that folder. Throws std::runtime_error naming the file.
  static RobotDescription read(const std::filesystem::path& urdf, const std::optional<std::filesystem::path>& srdf = {},
                               const std::map<std::string, std::filesystem::path>& packages = {});
};

/// The mesh files that the collision shapes of a URDF name, each once, sorted. Throws std::runtime_error if it is no XML.
std::vector<std::string> mesh_names(const std::string& urdf);

/// A model that the daemon has loaded. It may stand in any number of scenes.
struct Robot {
  explicit Robot(v1::RobotModel model);

  /// Names the model in the daemon.
  std::string id;
  /// As in the URDF.
  std::string name;
  /// How many numbers a vector of joint positions has.
  std::size_t degrees_of_freedom;
  /// By the indices that answers use.
  std::vector<std::string> links;
  /// Limits of each number of a vector of joint positions; infinite where there are none.
  std::vector<double> lower;
  std::vector<double> upper;
  /// Everything known of it.
  v1::RobotModel model;
};

}  // namespace clearance
