#pragma once
// The text messages of a page to the server: docs/view_protocol.md. Replies: replies.h.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "gloam/result.h"

namespace gloam::studio {

inline constexpr int kMaxStepCount = 100;
inline constexpr double kMinSpeed = 0.001, kMaxSpeed = 100;
inline constexpr double kMaxTime = 1e9;  // [s]
inline constexpr int kPicturesInFlight = 2;
inline constexpr int kMaxFields = 64;
inline constexpr double kMinWatchRate = 0.1, kMaxWatchRate = 30;  // per second

struct PauseMessage {};
struct ResumeMessage {};
struct StepMessage {
  int count = 1;  ///< 1 … kMaxStepCount
};
/// Goes back.
struct BackMessage {
  int count = 1;  ///< steps, 1 … kMaxStepCount
};
struct SpeedMessage {
  double value = 1;  ///< simulated seconds per wall second, kMinSpeed … kMaxSpeed
};
struct ResetMessage {};
/// Goes to an instant of a log that is played, or of the simulation's recent past.
struct SeekMessage {
  double time = 0;  ///< [s], 0 … kMaxTime
};

// State. Elements are given by their index in MuJoCo.
struct SetJointMessage {
  int joint = 0;
  std::vector<double> qpos;
};
struct SetControlMessage {
  int actuator = 0;
  double value = 0;
};
struct ClearControlsMessage {};
struct SetEqualityMessage {
  int equality = 0;
  bool active = true;
};
struct LoadKeyframeMessage {
  int keyframe = 0;
};
struct CopyStateMessage {};
struct PasteStateMessage {
  std::string text;  ///< a <key> element of MJCF
};
struct DriveMessage {
  int robot = 0;
  double vx = 0, vy = 0, yaw_rate = 0, vz = 0;  ///< [m/s], [rad/s]
};

/// A point of a picture [px]: u to the right, v down, as in gloam::Intrinsics.
struct Pixel {
  double u = 0, v = 0;
  int width = 0;  ///< of the picture that the client shows; 0 = of the newest
};

// The camera. Travel of the mouse is in heights of the picture, to the right and down.
struct CameraMessage {
  std::string name;
};
/// Turns the free camera about its pivot: 1 = half a turn.
struct OrbitMessage {
  double dx = 0, dy = 0;
};
/// Moves the free camera with its pivot, so that the pivot follows the mouse.
struct PanMessage {
  double dx = 0, dy = 0;
};
struct ZoomMessage {
  double amount = 0;  ///< > 0 goes closer; the distance is multiplied by exp(-amount)
};
/// Moves the pivot to the point at a pixel.
struct LookAtMessage : Pixel {};
/// The pivot follows a body.
struct TrackMessage {
  int body = -1;  ///< -1 = none
};
struct PickMessage : Pixel {};
struct DragStartMessage : Pixel {
  bool turn = false;  ///< rotates the body instead of pulling it
};
struct DragMoveMessage : Pixel {};
struct DragEndMessage {};

// Data of the model and of the present instant.
struct DescribeMessage {};
struct GetMessage {
  int id = 1;
  std::vector<std::string> fields;
};
struct WatchMessage {
  std::vector<std::string> fields;  ///< none = no longer
  double rate = 20;                 ///< at most, per second
};

/// How the client wants its pictures.
struct CodecMessage {
  bool is_h264 = false;
};
struct ClaimMessage {};
struct ReleaseMessage {};
/// The client has shown a picture; the server sends no more than kPicturesInFlight ahead.
struct SeenMessage {};

using ControlMessage =
    std::variant<PauseMessage, ResumeMessage, StepMessage, BackMessage, SpeedMessage, ResetMessage,
                 SeekMessage, SetJointMessage, SetControlMessage, ClearControlsMessage,
                 SetEqualityMessage, LoadKeyframeMessage, CopyStateMessage, PasteStateMessage,
                 DriveMessage, CameraMessage, OrbitMessage, PanMessage, ZoomMessage, LookAtMessage,
                 TrackMessage, PickMessage, DragStartMessage, DragMoveMessage, DragEndMessage,
                 DescribeMessage, GetMessage, WatchMessage, CodecMessage, ClaimMessage,
                 ReleaseMessage, SeenMessage>;

/// Reads one message. Errors: not JSON, unknown type or key, a value missing or out of range.
Result<ControlMessage> parse_message(std::string_view text);

/// Whether it asks for data of the model or the present instant.
bool is_about_data(const ControlMessage& message);
/// Whether a client may send it without being in control.
bool is_for_watchers(const ControlMessage& message);

}  // namespace gloam::studio
