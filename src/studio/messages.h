#pragma once
// The text messages between a page and the server: docs/view_protocol.md.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam::studio {

struct PauseMessage {};
struct ResumeMessage {};
struct StepMessage {
  int count = 1;  ///< 1 … kMaxStepCount
};
struct SpeedMessage {
  double value = 1;  ///< simulated seconds per wall second, kMinSpeed … kMaxSpeed
};
struct ResetMessage {};
/// Goes to an instant of a log that is played.
struct SeekMessage {
  double time = 0;  ///< [s], 0 … kMaxTime
};
struct CameraMessage {
  std::string name;
};
/// Turns the free camera about its pivot: 1 = half a turn.
struct OrbitMessage {
  double dx = 0, dy = 0;  ///< mouse travel in picture heights, right and down
};
/// Moves the free camera with its pivot, so that the pivot follows the mouse.
struct PanMessage {
  double dx = 0, dy = 0;  ///< mouse travel in picture heights, right and down
};
struct ZoomMessage {
  double amount = 0;  ///< > 0 goes closer; the distance is multiplied by exp(-amount)
};
/// Pixels of the newest picture, u to the right, v down, as gloam::Intrinsics has them.
struct PickMessage {
  double u = 0, v = 0;
};
struct DragStartMessage {
  double u = 0, v = 0;
};
struct DragMoveMessage {
  double u = 0, v = 0;
};
struct DragEndMessage {};
struct ClaimMessage {};
struct ReleaseMessage {};
/// The client has shown a picture; the server sends no more than kPicturesInFlight ahead.
struct SeenMessage {};

using ControlMessage =
    std::variant<PauseMessage, ResumeMessage, StepMessage, SpeedMessage, ResetMessage, SeekMessage,
                 CameraMessage, OrbitMessage, PanMessage, ZoomMessage, PickMessage,
                 DragStartMessage, DragMoveMessage, DragEndMessage, ClaimMessage, ReleaseMessage,
                 SeenMessage>;

inline constexpr int kMaxStepCount = 100;
inline constexpr double kMinSpeed = 0.001, kMaxSpeed = 100;
inline constexpr double kMaxTime = 1e9;  // [s]
inline constexpr int kPicturesInFlight = 2;

/// Reads one message. Errors: not JSON, unknown type or key, a value missing or out of range.
Result<ControlMessage> parse_message(std::string_view text);

/// State that every client is told ten times a second.
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
  int64_t controller = 0;  ///< client number; 0 = nobody
};

/// `log_end`: of a log that is played [s], 0 = none is.
std::string hello_message(int64_t client, const std::vector<std::string>& cameras, double step_rate,
                          double log_end);
std::string state_message(const ViewState& state);
/// Answer to a pick or the start of a drag; `point_W` [m] is where the line of a drag begins.
std::string picked_message(std::string_view body, const Vec3& point_W, bool dragging);
/// Answer to a pick that hit nothing.
std::string picked_nothing_message();
/// New place of the point that is dragged [m].
std::string pulled_message(const Vec3& point_W);
/// Something the user should read.
std::string notice_message(std::string_view text);

}  // namespace gloam::studio
