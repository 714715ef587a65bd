/// Edits of a scene, for Scene::apply. They are made in order, all or none. Fields that these functions leave out are set on the
/// message they return, for example `edit.mutable_add_body()->add_groups("fixtures")`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "clearance/geometry.hpp"
#include "clearance/robot.hpp"
#include "clearance/v1/query.pb.h"
#include "clearance/v1/scene.pb.h"

namespace clearance {

/// A body, by its name or by the id the scene gave it.
class Body {
 public:
  Body(const char* name);
  Body(const std::string& name);
  Body(std::uint64_t id);

  const v1::BodyRef& message() const { return message_; }

 private:
  v1::BodyRef message_;
};

v1::Edit add_body(const std::string& name, const v1::Shape& shape, const v1::Pose& pose = {});
v1::Edit move_body(const Body& body, const v1::Pose& pose);
v1::Edit remove_body(const Body& body);
v1::Edit replace_shape(const Body& body, const v1::Shape& shape);
/// Whether a body takes part.
v1::Edit set_enabled(const Body& body, bool enabled);
/// A body of voxels gets the cells of these points too; in the body's frame.
v1::Edit insert_points(const Body& body, const std::vector<Point>& points);
/// A body of voxels loses every cell that a point of the box belongs to; in the body's frame.
v1::Edit clear_box(const Body& body, const Point& least, const Point& greatest);
/// A loaded robot stands in the scene; `base` is the pose of its root link.
v1::Edit add_robot(const std::string& name, const Robot& robot, const v1::Pose& base = {});
v1::Edit move_robot(const std::string& name, const v1::Pose& base);
v1::Edit remove_robot(const std::string& name);
/// True: the pair is not looked at. False: it is, whatever less specific entries say.
v1::Edit allow_collision(const v1::Party& a, const v1::Party& b, bool allowed = true);
/// The margin of this pair in metres, in place of the question's.
v1::Edit set_pair_margin(const v1::Party& a, const v1::Party& b, double margin);
/// What may be asked of a pair; with each effect goes what it needs. Of none the pair is not looked at, and answers list it in
/// their coverage.
v1::Edit declare_effects(const v1::Party& a, const v1::Party& b, const std::vector<v1::Effect>& effects);

/// Sides of an entry for pairs.
v1::Party one_body(const Body& body);
v1::Party one_link(const std::string& robot, const std::string& link);
v1::Party group(const std::string& name);
v1::Party all_links(const std::string& robot);
v1::Party everything();

/// What a question holds against the scene: one body against the others.
v1::Subject subject(const Body& body);
/// A shape that is not in the scene, against all bodies.
v1::Subject subject(const v1::Shape& shape, const v1::Pose& pose);
/// Every pair of bodies that changed after a revision.
v1::Subject changed_since(std::uint64_t revision);

}  // namespace clearance
