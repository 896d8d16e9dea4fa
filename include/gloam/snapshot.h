#pragma once
// Snapshot: one instant of a simulation, or of a World in a given configuration; immutable.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gloam/actuators.h"
#include "gloam/joints/joint_trajectory.h"
#include "gloam/result.h"
#include "gloam/types.h"
#include "gloam/world.h"

struct mjModel_;
struct mjData_;

namespace gloam {

struct Command;       // gloam/command.h
struct SnapshotData;  // src/sim/snapshots/snapshot.h

/// State of one joint in one Snapshot. The spans are valid as long as the Snapshot.
struct JointState {
  /// 1 (hinge [rad], slide [m]), 4 (ball, wxyz) or 7 (free: xyz, wxyz).
  std::span<const double> qpos;
  std::span<const double> qvel;  ///< 1, 3 or 6 [rad/s, m/s]
  double position() const { return qpos[0]; }
  double velocity() const { return qvel[0]; }
};

/// Values of one MuJoCo sensor and the time of the state from which they were computed.
struct SensorState {
  std::span<const double> values;
  /// [s] one timestep before Snapshot::time after a step, see ARCHITECTURE.md "Poses".
  double stamp = 0;
};

class Snapshot {
 public:
  Snapshot() = default;
  explicit Snapshot(std::shared_ptr<const SnapshotData> data) : data_(std::move(data)) {}
  explicit operator bool() const { return data_ != nullptr; }

  int64_t step() const;                   ///< steps since reset
  double time() const;                    ///< simulation time [s]
  uint64_t hash() const;                  ///< state hash chained over all steps since reset
  std::span<const double> state() const;  ///< mjSTATE_INTEGRATION, in mj_getState's order

  JointState operator[](Joint joint) const;
  SensorState operator[](SensorHandle sensor) const;
  /// Poses X_WB of all mocap bodies, in MuJoCo's order.
  std::vector<Pose> mocap_poses() const;
  /// The commanded control, the first value if there are several.
  double control(Actuator actuator) const;
  /// The trajectory of a joint, from its first step until another Command ends it; stays after its
  /// last point. Null: none.
  std::shared_ptr<const ActiveTrajectory> trajectory(Joint joint) const;
  /// The one of its joints' trajectories that started last. Null: none.
  std::shared_ptr<const ActiveTrajectory> trajectory(Robot robot) const;
  /// Valid as long as the Snapshot. Null: the robot has no actuator models, or this is a replay or
  /// of World::snapshot().
  const ActuatorOutputs* actuators(Robot robot) const;

  World world() const;  ///< World of this instant; a recompile replaces it

  /// The same instant after these Commands, for views of a paused simulation: positions,
  /// velocities, controls, mocap poses and equality constraints; other Commands have no effect
  /// before a step. Sensor values stay. Error: a Command that Simulation::post() rejects.
  Result<Snapshot> with(std::span<const Command> commands) const;

  const SnapshotData& data() const { return *data_; }

 private:
  std::shared_ptr<const SnapshotData> data_;
};

/// A body at an instant, world axes.
struct BodyState {
  Pose X_WB;
  Vec3 velocity, angular_velocity;       ///< velocity of its origin [m/s], [rad/s]
  Vec3 external_force, external_torque;  ///< applied at its centre of mass [N], [N m]
};

struct TendonState {
  double length = 0, velocity = 0;  ///< [m] or of a fixed tendon its joints' unit; per second
};

/// Two geoms in contact. A missing geom means that a flex is in contact.
struct ContactState {
  Geom geoms[2];
  Vec3 position;        ///< between the surfaces [m]
  Vec3 normal;          ///< unit, from the first geom to the second
  Vec3 tangents[2];     ///< complete the frame
  double distance = 0;  ///< distance between the surfaces; negative = they overlap [m]
  double friction = 0;  ///< coefficient of sliding friction
  Vec3 force, torque;   ///< on the second geom, world axes [N], [N m]
};

/// All quantities that MuJoCo computes from a Snapshot in one forward pass: poses, velocities,
/// forces of actuators and contacts, any array by name. Keeps its memory from one Snapshot to the
/// next. Use it from one thread at a time. Errors: a handle of another World than the last
/// Snapshot's, an unknown name.
class Instant {
 public:
  Instant();
  ~Instant();
  Instant(Instant&&) noexcept;
  Instant& operator=(Instant&&) noexcept;

  /// Has to be called first. Error: reported by MuJoCo.
  Status solve(const Snapshot& snapshot);

  Result<BodyState> body(Body body) const;
  Result<TendonState> tendon(Tendon tendon) const;
  Result<double> force(Actuator actuator) const;  ///< in the actuator's space: N, N m
  std::vector<ContactState> contacts() const;
  /// The same, into a vector whose memory is reused.
  void contacts(std::vector<ContactState>* contacts) const;

  /// Returns the numbers of a field of mjData, mjModel or its options ("opt.gravity") by its name
  /// in MuJoCo: all rows, or the rows of one named element: value("xfrc_applied", "go1/trunk"),
  /// value("qpos", "arm/elbow"), value("geom_friction", "floor").
  Result<std::vector<double>> value(const std::string& field,
                                    const std::string& element = {}) const;

  /// MuJoCo's own structs, valid from a successful solve() until the next; for programs that link
  /// MuJoCo.
  const mjModel_* model() const;
  const mjData_* data() const;

 private:
  struct Solved;
  std::unique_ptr<Solved> solved_;
};

}  // namespace gloam
