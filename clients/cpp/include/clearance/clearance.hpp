/// Ask a clearance daemon how far apart things are.
///
///     clearance::Client client("127.0.0.1:50551");
///     auto scene = client.create_scene("cell");
///     scene.apply({clearance::add_body("ball", clearance::sphere(0.5), clearance::at(0, 0, 1))});
///
/// Metres, radians, right-handed frames. What goes wrong with a request is thrown as clearance::Error; geometry never is, it is
/// a verdict. Messages are those of namespace clearance::v1, generated from proto/clearance/v1.
#pragma once

#include "clearance/answers.hpp"
#include "clearance/client.hpp"
#include "clearance/edits.hpp"
#include "clearance/error.hpp"
#include "clearance/estimate.hpp"
#include "clearance/geometry.hpp"
#include "clearance/question.hpp"
#include "clearance/robot.hpp"
#include "clearance/scene.hpp"
