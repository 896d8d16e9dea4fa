#pragma once
// Sensors of an instant of a running simulation, MuJoCo's and probes: a thread that turns Snapshots
// into messages.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gloam/sensor.h"
#include "runtime/streams/stream_context.h"
#include "runtime/streams/stream_thread.h"
#include "sensors/sensor_group.h"
#include "sim/loop/simulator.h"

namespace gloam {

struct LiveSensorsRequest {
  std::vector<std::string> sensors;
  bool required = false;
  int batch = 1;  ///< as SubscriptionOptions::batch, 1 … 64
  /// The first step at or after the one given whose samples the reader uses; empty = every step
  /// with a sample. For sensors without errors, whose samples do not hang on those before.
  std::function<int64_t(int64_t step)> used = {};
  /// A recompile has taken a sensor away or changed its steps: the others go on. Empty = the stream
  /// ends.
  std::function<void(const Error&)> on_lost = {};
  EndCallback on_end = {};
};

class LiveSensors final : public SensorStream {
 public:
  /// `sources`: of probes, while it is open. Errors: no such sensor, SensorGroup's.
  static Result<std::unique_ptr<LiveSensors>> open(const StreamContext& context,
                                                   ProbeSources sources, LiveSensorsRequest request,
                                                   SensorCallback on_message);
  int64_t dropped() const override { return thread_.dropped(); }
  int64_t complete_at(int64_t from) const override { return thread_.complete_at(from); }
  void flush() override { thread_.flush(); }
  Status status() const override { return thread_.status(); }
  /// Waits until the simulation has stopped and every message was delivered.
  void drain() { thread_.drain(); }
  /// Delivers nothing more, what waits included.
  void abandon() { thread_.abandon(); }

 private:
  using WorldPtr = std::shared_ptr<const CompiledWorld>;
  LiveSensors(uint64_t seed, ProbeSources sources, LiveSensorsRequest request,
              SensorCallback on_message)
      : seed_(seed),
        sources_(std::move(sources)),
        request_(std::move(request)),
        on_message_(std::move(on_message)) {}
  Result<SensorGroup> group_of(const std::vector<std::string>& names, const CompiledWorld& world,
                               Rational timestep) const;
  Status follow(const WorldPtr& world, Rational timestep);
  Status sample(const Snapshot& snapshot, Rational timestep);

  const uint64_t seed_;
  const ProbeSources sources_;
  LiveSensorsRequest request_;
  SensorCallback on_message_;
  // World whose Snapshots come; holds the group's options
  WorldPtr world_;
  SensorGroup group_;
  std::shared_ptr<SensorAccount> account_;
  StreamThread thread_;  // last: it uses the others
};

}  // namespace gloam
