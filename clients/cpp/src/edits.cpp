#include "clearance/edits.hpp"

namespace clearance {

Body::Body(const char* name) { message_.set_name(name); }
Body::Body(const std::string& name) { message_.set_name(name); }
Body::Body(std::uint64_t id) { message_.set_id(id); }

v1::Edit add_body(const std::string& name, const v1::Shape& shape, const v1::Pose& pose) {
  v1::Edit edit;
  auto& message = *edit.mutable_add_body();
  message.set_name(name);
  *message.mutable_shape() = shape;
  *message.mutable_pose() = pose;
  return edit;
}

v1::Edit move_body(const Body& body, const v1::Pose& pose) {
  v1::Edit edit;
  *edit.mutable_move_body()->mutable_body() = body.message();
  *edit.mutable_move_body()->mutable_pose() = pose;
  return edit;
}

v1::Edit remove_body(const Body& body) {
  v1::Edit edit;
  *edit.mutable_remove_body()->mutable_body() = body.message();
  return edit;
}

v1::Edit replace_shape(const Body& body, const v1::Shape& shape) {
  v1::Edit edit;
  *edit.mutable_replace_shape()->mutable_body() = body.message();
  *edit.mutable_replace_shape()->mutable_shape() = shape;
  return edit;
}

v1::Edit set_enabled(const Body& body, bool enabled) {
  v1::Edit edit;
  *edit.mutable_set_enabled()->mutable_body() = body.message();
  edit.mutable_set_enabled()->set_enabled(enabled);
  return edit;
}

v1::Edit insert_points(const Body& body, const std::vector<Point>& points) {
  v1::Edit edit;
  *edit.mutable_insert_points()->mutable_body() = body.message();
  *edit.mutable_insert_points()->mutable_points() = numbers(points);
  return edit;
}

v1::Edit clear_box(const Body& body, const Point& least, const Point& greatest) {
  v1::Edit edit;
  auto& message = *edit.mutable_clear_box();
  *message.mutable_body() = body.message();
  *message.mutable_box()->mutable_min() = vec3(least);
  *message.mutable_box()->mutable_max() = vec3(greatest);
  return edit;
}

v1::Edit add_robot(const std::string& name, const Robot& robot, const v1::Pose& base) {
  v1::Edit edit;
  auto& message = *edit.mutable_add_robot();
  message.set_name(name);
  message.set_model(robot.id);
  *message.mutable_base() = base;
  return edit;
}

v1::Edit move_robot(const std::string& name, const v1::Pose& base) {
  v1::Edit edit;
  edit.mutable_move_robot()->set_robot(name);
  *edit.mutable_move_robot()->mutable_base() = base;
  return edit;
}

v1::Edit remove_robot(const std::string& name) {
  v1::Edit edit;
  edit.mutable_remove_robot()->set_robot(name);
  return edit;
}

v1::Edit allow_collision(const v1::Party& a, const v1::Party& b, bool allowed) {
  v1::Edit edit;
  auto& message = *edit.mutable_set_allowed_collision();
  *message.mutable_a() = a;
  *message.mutable_b() = b;
  message.set_allowed(allowed);
  return edit;
}

v1::Edit set_pair_margin(const v1::Party& a, const v1::Party& b, double margin) {
  v1::Edit edit;
  auto& message = *edit.mutable_set_pair_margin();
  *message.mutable_a() = a;
  *message.mutable_b() = b;
  message.set_margin(margin);
  return edit;
}

v1::Edit declare_effects(const v1::Party& a, const v1::Party& b, const std::vector<v1::Effect>& effects) {
  v1::Edit edit;
  auto& message = *edit.mutable_declare_effects();
  *message.mutable_a() = a;
  *message.mutable_b() = b;
  auto& declared = *message.mutable_effects();
  for (const v1::Effect effect : effects) declared.add_effects(effect);
  return edit;
}

v1::Party one_body(const Body& body) {
  v1::Party party;
  *party.mutable_body() = body.message();
  return party;
}

v1::Party one_link(const std::string& robot, const std::string& link) {
  v1::Party party;
  party.mutable_link()->set_robot(robot);
  party.mutable_link()->set_link(link);
  return party;
}

v1::Party group(const std::string& name) {
  v1::Party party;
  party.set_group(name);
  return party;
}

v1::Party all_links(const std::string& robot) {
  v1::Party party;
  party.set_robot(robot);
  return party;
}

v1::Party everything() {
  v1::Party party;
  party.mutable_everything();
  return party;
}

v1::Subject subject(const Body& body) {
  v1::Subject message;
  *message.mutable_body() = body.message();
  return message;
}

v1::Subject subject(const v1::Shape& shape, const v1::Pose& pose) {
  v1::Subject message;
  *message.mutable_shape()->mutable_shape() = shape;
  *message.mutable_shape()->mutable_pose() = pose;
  return message;
}

v1::Subject changed_since(std::uint64_t revision) {
  v1::Subject message;
  message.mutable_changed_since()->set_revision(revision);
  return message;
}

}  // namespace clearance
