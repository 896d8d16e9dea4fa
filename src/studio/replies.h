#pragma once
// The text messages of the server to a page: docs/view_protocol.md.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/types.h"
#include "gloam/world.h"

namespace gloam::studio {

struct Greeting {
  int64_t client = 0;
  std::string title;  ///< of the scene
  std::vector<std::string> cameras;
  double step_rate = 0;
  double log_end = 0;  ///< of a log that is played [s]; 0 = none is
};

/// State that every client is sent ten times a second.
struct ViewState {
  int64_t step = 0;
  double time = 0;  ///< [s]
  uint64_t hash = 0;
  double realtime_factor = 0;
  bool paused = true;
  double speed = 1;
  std::string camera;
  int64_t dropped = 0;   ///< pictures the renderer has dropped
  int64_t warnings = 0;  ///< of the physics
  std::string error;     ///< why the simulation or the picture stopped; empty = all is well
  int clients = 0;
  int64_t controller = 0;    ///< client number; 0 = nobody
  double history_start = 0;  ///< earliest instant to which seek returns [s]
  int64_t run = 0;           ///< resets and returns so far
  uint64_t serial = 0;       ///< of the World
};

std::string hello_message(const Greeting& greeting);
std::string state_message(const ViewState& state);
/// Names of the model's elements.
std::string model_message(const World& world);
/// Answer to a pick or the start of a drag; `point_W` [m] is where the line of a drag begins.
std::string picked_message(Body body, std::string_view name, const Vec3& point_W, bool dragging);
/// Answer to a pick that hit nothing.
std::string picked_nothing_message();
/// New place of the point that is dragged [m].
std::string pulled_message(const Vec3& point_W);
/// The state as MJCF.
std::string copied_message(std::string_view key);
/// Something the user should read.
std::string notice_message(std::string_view text);

}  // namespace gloam::studio
