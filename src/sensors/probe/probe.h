#pragma once
// Probes: sensors whose numbers are a function of an instant. A quantity is a row of the table in
// scene/options/probe_quantities.h and a maker of readers in probe_list.cc; its family is a file.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/renderer.h"
#include "render/turns.h"
#include "sim/snapshots/pose_solver.h"
#include "world/sensors/probe_description.h"

namespace gloam {

/// A World's renderer, which cameras use as well.
struct ProbeRenderer {
  std::shared_ptr<const void> owner;  ///< keeps the others
  const RenderDescription* description = nullptr;
  Renderer* renderer = nullptr;
  RenderTurns* turns = nullptr;  ///< taken while `renderer` works
};

/// Answers of the simulation to its probes. Called on a stream's thread, when a probe that needs
/// one is opened or read.
struct ProbeSources {
  using WorldPtr = std::shared_ptr<const CompiledWorld>;
  /// Error: the scene cannot be rendered.
  std::function<Result<ProbeRenderer>(const WorldPtr&)> renderer = {};
  /// Reading of a camera's exposure meter [EV] at an instant, after waiting for it. Error: it has
  /// an automatic exposure that nobody meters.
  std::function<Result<double>(const std::string& camera, const Snapshot&)> metered_ev100 = {};
};

/// An instant as probes see it. Poses and contacts are solved for when they are first asked for;
/// the memory for them is used again. One World; one thread at a time.
class ProbeInstant {
 public:
  explicit ProbeInstant(std::shared_ptr<const CompiledWorld> world) : world_(std::move(world)) {}

  /// The instant that is read from now on; the caller holds it until it has been.
  void follow(const Snapshot& snapshot);
  const Snapshot& snapshot() const { return *snapshot_; }
  const SnapshotData& data() const { return snapshot_->data(); }
  const CompiledWorld& world() const { return *world_; }

  /// Places from the render origin. Error: MuJoCo's.
  Result<const PoseFrame*> poses();
  /// Contacts with their forces, as a forward pass tells. Error: MuJoCo's.
  Result<const std::vector<ContactState>*> contacts();
  /// Place of a probe in the world [m]. Error: MuJoCo's.
  Result<Vec3> place(const ProbeDescription& probe);
  /// Normal of a probe, unit, world. Error: MuJoCo's.
  Result<Vec3> normal(const ProbeDescription& probe);

 private:
  Result<Vec3> turned(int body, const Vec3& v_B);

  const std::shared_ptr<const CompiledWorld> world_;
  const Snapshot* snapshot_ = nullptr;
  std::unique_ptr<PoseSolver> solver_;
  PoseFrame poses_;
  Instant instant_;
  std::vector<ContactState> contacts_;
  bool has_poses_ = false, has_contacts_ = false;
};

/// Fills the numbers of a quantity; NaN = there is none there now. Error: MuJoCo's, a source's.
using ProbeReader = std::function<Status(ProbeInstant& at, std::span<double> numbers)>;

struct ProbeSetup {
  std::shared_ptr<const CompiledWorld> world;
  const ProbeSources& sources;
  /// Error: the scene cannot be rendered, or where the probe is read nothing is.
  Result<ProbeRenderer> renderer() const;
};

/// The description lives as long as the World. Errors: those of the sources.
Result<ProbeReader> make_probe_reader(const ProbeDescription& probe, const ProbeSetup& setup);

}  // namespace gloam
