#pragma once
// ActuatorLayer: models of a robot's actuators between its controls and MuJoCo. The step loop knows
// them by this interface alone; control/actuators/ has the models.

#include <memory>
#include <vector>

#include "gloam/result.h"
#include "gloam/types.h"
#include "sim/snapshots/actuator_outputs.h"
#include "sim/state/correspondence.h"

namespace gloam {

/// The models of one robot. All calls come on the simulation's thread; apply() must not allocate,
/// lock or throw.
class ActuatorLayer {
 public:
  virtual ~ActuatorLayer() = default;
  /// Before everything else, once: steps take `timestep` [s]. Error: a delay or period is not a
  /// multiple of it.
  virtual Status begin(const mjModel& model, Rational timestep) = 0;
  /// The simulation stands at its initial state, or a recompile added the robot.
  virtual void reset(const mjModel& model, const mjData& data) = 0;
  /// Goes on from the models of the same robot in the World before a recompile.
  virtual void take_over(const mjModel& model, const mjData& data, const ActuatorLayer& before) = 0;
  /// Before a step: replaces the controls of its actuators, which are within their limits, by the
  /// applied ones. False and error() when a model fails.
  virtual bool apply(const mjModel& model, mjData& data) = 0;
  /// After the step; mjData has the poses and velocities of its beginning.
  virtual void observe(const mjModel& model, const mjData& data) = 0;
  virtual Error error() const = 0;
  /// Hash of all that decides the future, chained from `before`.
  virtual uint64_t hash(uint64_t before) const = 0;
  virtual void publish(ActuatorOutputs* out) const = 0;
  virtual std::unique_ptr<ActuatorLayer> clone() const = 0;
};

/// The layers of a simulation. During a step mjData holds the applied controls, between steps the
/// commanded ones: a control that nobody changes is commanded again.
class ActuatorLayers {
 public:
  ActuatorLayers() = default;
  ActuatorLayers(const ActuatorLayers& other);
  ActuatorLayers& operator=(const ActuatorLayers& other);
  ActuatorLayers(ActuatorLayers&&) noexcept = default;
  ActuatorLayers& operator=(ActuatorLayers&&) noexcept = default;
  ~ActuatorLayers() = default;

  bool empty() const { return robots_.empty(); }
  Status add(int robot, std::unique_ptr<ActuatorLayer> layer, const mjModel& model,
             const mjData& data);
  void reset(const mjModel& model, const mjData& data);
  void take_over(const ActuatorLayers& before, const Correspondence& same, const mjModel& model,
                 const mjData& data);
  /// Before a step; release() after it. False: error().
  bool apply(mjModel* model, mjData* data);
  void release(mjModel* model, mjData* data);
  const Error& error() const { return error_; }
  uint64_t hash(uint64_t before) const;
  void publish(std::vector<ActuatorOutputs>* out) const;

 private:
  struct Entry {
    int robot;
    std::unique_ptr<ActuatorLayer> layer;
  };
  std::vector<Entry> robots_;
  std::vector<double> commanded_;  // controls, (nu)
  int flags_ = 0;                  // of the model, of steps without layers
  bool applied_ = false;
  Error error_;
};

}  // namespace gloam
