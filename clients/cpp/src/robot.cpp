#include "clearance/robot.hpp"

#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include <expat.h>

namespace clearance {
namespace {

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) throw std::runtime_error(path.string() + ": cannot be read");
  return bytes;
}

std::filesystem::path resolve(const std::string& name, const std::filesystem::path& folder,
                              const std::map<std::string, std::filesystem::path>& packages) {
  const std::string package = "package://", file = "file://";
  if (name.compare(0, package.size(), package) == 0) {
    const auto rest = name.substr(package.size());
    const auto slash = rest.find('/');
    const auto known = packages.find(rest.substr(0, slash));
    const auto path = slash == std::string::npos ? std::string() : rest.substr(slash + 1);
    return (known == packages.end() ? folder : known->second) / path;
  }
  if (name.compare(0, file.size(), file) == 0) return folder / name.substr(file.size());
  return folder / name;
}

/// Where the reader of a URDF is, and what it has found.
struct Reading {
  std::vector<std::string> path;
  std::set<std::string> names;

  static void XMLCALL begin(void* user, const XML_Char* element, const XML_Char** attributes) {
    auto& reading = *static_cast<Reading*>(user);
    reading.path.emplace_back(element);
    static const std::vector<std::string> wanted{"robot", "link", "collision", "geometry", "mesh"};
    if (reading.path != wanted) return;
    std::string name;
    for (; *attributes != nullptr; attributes += 2) {
      if (std::string_view(attributes[0]) == "filename") name = attributes[1];
    }
    reading.names.insert(name);
  }

  static void XMLCALL end(void* user, const XML_Char*) { static_cast<Reading*>(user)->path.pop_back(); }
};

}  // namespace

std::vector<std::string> mesh_names(const std::string& urdf) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), &XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  Reading reading;
  XML_SetUserData(parser.get(), &reading);
  XML_SetElementHandler(parser.get(), &Reading::begin, &Reading::end);
  if (XML_Parse(parser.get(), urdf.data(), static_cast<int>(urdf.size()), XML_TRUE) != XML_STATUS_OK) {
    throw std::runtime_error(std::string("the URDF is not XML: line ") + std::to_string(XML_GetCurrentLineNumber(parser.get())) +
                             ": " + XML_ErrorString(XML_GetErrorCode(parser.get())));
  }
  return {reading.names.begin(), reading.names.end()};
}

RobotDescription RobotDescription::read(const std::filesystem::path& urdf, const std::optional<std::filesystem::path>& srdf,
                                        const std::map<std::string, std::filesystem::path>& packages) {
  RobotDescription description;
  description.urdf = read_file(urdf);
  if (srdf) description.srdf = read_file(*srdf);
  for (const auto& name : mesh_names(description.urdf)) {
    description.meshes[name] = read_file(resolve(name, urdf.parent_path(), packages));
  }
  return description;
}

Robot::Robot(v1::RobotModel from)
    : id(from.id()), name(from.name()), degrees_of_freedom(from.degrees_of_freedom()), model(std::move(from)) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  for (const auto& link : model.links()) links.push_back(link.name());
  for (const auto& joint : model.joints()) {
    lower.insert(lower.end(), joint.width(), joint.has_lower() ? joint.lower() : -infinite);
    upper.insert(upper.end(), joint.width(), joint.has_upper() ? joint.upper() : infinite);
  }
}

}  // namespace clearance
