#pragma once
// Topic: a row of the table of topics, with the stream that its data come from and the function
// that makes messages of them. A kind of topics is a file that adds its rows, and a line in
// topic_table.cc.

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "gloam/camera.h"
#include "gloam/command.h"
#include "gloam/sensor.h"
#include "gloam/simulation_options.h"
#include "gloam/topics.h"
#include "ros/codec.h"
#include "sim/snapshots/pose_solver.h"

namespace gloam {

/// An instant as encoders see it. Poses and forces are solved for when they are first asked for.
class TopicInstant {
 public:
  /// Tells how the running simulation does by the wall clock.
  using Performance = std::function<SimulationStats()>;

  TopicInstant(const Snapshot& snapshot, PoseSolver& solver, Performance performance = {})
      : snapshot_(snapshot), solver_(solver), performance_(std::move(performance)) {}
  const Snapshot& snapshot() const { return snapshot_; }
  const mjModel& model() const { return *snapshot_.data().world->model; }
  /// Pose of a body in the world. Error: MuJoCo's.
  Result<Pose> X_WB(int body);
  /// All that a forward pass tells.
  Result<const Instant*> forces();
  /// Not a function of the instant: for topics that are in no log.
  SimulationStats performance() const { return performance_ ? performance_() : SimulationStats(); }

 private:
  const Snapshot& snapshot_;
  PoseSolver& solver_;
  Performance performance_;
  PoseFrame poses_;
  Instant instant_;
  bool has_poses_ = false, has_forces_ = false;
};

using MessageBytes = std::vector<uint8_t>;
using FrameEncoder = std::function<Status(const TopicInfo&, const CameraFrame&, MessageBytes*)>;
/// Makes the encoder of one subscription, which remembers the pictures before.
using FrameEncoderMaker = std::function<FrameEncoder()>;
using ScanEncoder = std::function<Status(const TopicInfo&, const LidarScan&, MessageBytes*)>;
/// One sample of each of the topic's streams, all of one step.
using SampleEncoder =
    std::function<Status(const TopicInfo&, std::span<const SensorMessage>, MessageBytes*)>;
using InstantEncoder = std::function<Status(const TopicInfo&, TopicInstant&, MessageBytes*)>;
/// Makes the encoder of one subscription, which sums up the instants before.
using InstantEncoderMaker = std::function<InstantEncoder()>;
/// Inputs of latched topics at the moment that they are opened.
struct LatchedInputs {
  double time = 0;                                             ///< simulation time [s]
  std::function<Result<std::vector<LabelRow>>()> labels = {};  ///< of what pictures show; slow
};
using LatchedEncoder = std::function<Status(const TopicInfo&, const LatchedInputs&, MessageBytes*)>;
/// Commands of a message that is heard at an instant; steps take `timestep` [s].
using InputDecoder = std::function<Result<std::vector<Command>>(
    std::span<const uint8_t>, const Snapshot& now, double timestep)>;

/// Commands that applied at one step, as a log tells of them by input topics.
struct AppliedCommands {
  double time = 0;  ///< [s]
  std::span<const Command> commands;
  std::span<const double> controls;  ///< mjData::ctrl from then on, (nu)
  std::span<const uint8_t> is_set;   ///< 1 = this control was set at this step, (nu)
};
/// Makes the message of an input topic that asks for what Commands did; the function returns false
/// if none of them belongs to the topic.
using InputEcho = std::function<bool(const AppliedCommands&, MessageBytes*)>;

using TopicCode = std::variant<FrameEncoder, FrameEncoderMaker, ScanEncoder, SampleEncoder,
                               InstantEncoder, InstantEncoderMaker, LatchedEncoder, InputDecoder>;

struct Topic {
  TopicInfo info;
  std::vector<std::string> streams = {};  ///< camera, LiDAR or sensors; empty of others
  std::string channel = {};               ///< of CameraRequest::outputs
  TopicCode code;
  InputEcho echo = {};  ///< of an input; empty = a log has its messages as they came in
  /// How often an instant's encoder has to see the simulation, whatever the rate of its messages
  /// [Hz]: what it tells depends on all instants since it was opened. 0 = as often as messages.
  Rational sampled = {0, 1};
};

/// The message type of a struct, as TopicInfo::type.
template <Message T>
std::string type_name() {
  return std::string(T::kNamespace) + "/" + std::string(T::kName);
}

inline constexpr const char* kWorldFrameId = "world";
inline constexpr Rational kStateRate = {50, 1};    ///< of joints, poses, contacts [Hz]
inline constexpr Rational kSampleRate = {100, 1};  ///< of the clock and sensors without a rate
inline constexpr TopicQos kSensorQos = {.is_reliable = false, .depth = 5};
inline constexpr TopicQos kLatchedQos = {.is_latched = true, .depth = 1};

}  // namespace gloam
