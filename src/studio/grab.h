#pragma once
// A body in the grip of the mouse: pulled or turned by springs while the simulation runs, moved at
// once while it is paused (MuJoCo's perturbations).

#include <optional>
#include <vector>

#include "gloam/command.h"
#include "gloam/simulation.h"
#include "studio/free_camera.h"
#include "studio/messages.h"

namespace gloam::studio {

class Grab {
 public:
  /// Takes hold of the body under a pixel. Errors: nothing there, part of the world.
  static Result<Grab> take(int64_t client, Simulation& simulation, const CameraFrame& frame,
                           const DragStartMessage& message);

  int64_t client() const { return client_; }
  Body body() const { return hit_.body; }
  const PickResult& hit() const { return hit_; }
  void move_to(const CameraFrame& frame, double u, double v);

  /// The body's new goal in the image; empty: it has not changed.
  std::vector<Command> follow(const CameraFrame& frame, bool paused);
  /// Ends the spring.
  std::vector<Command> let_go() const;

 private:
  /// How a body is moved without forces.
  struct Placing {
    bool is_mocap = false;
    int free_joint = -1;  ///< -1 = none
  };
  static std::optional<Placing> placing_of(const Snapshot& now, int body);
  Grab(int64_t client, PickResult hit, bool turn)
      : client_(client), hit_(std::move(hit)), turn_(turn) {}
  std::optional<Pose> goal(const CameraFrame& frame) const;
  std::vector<Command> place(const Pose& X_WB) const;

  int64_t client_;
  PickResult hit_;
  bool turn_;
  std::optional<Placing> placing_;  // empty: springs only, since its state is not known
  Pose X_WB_;                       // of the body when it was taken
  double depth_ = 0;                // of the point, as CameraFrame::depth [m]
  double u_ = 0, v_ = 0;            // of the mouse, as parts of the image
  double u0_ = 0, v0_ = 0;          // where it was taken
  std::optional<Pose> last_;
  bool was_paused_ = false;  // at last_
};

}  // namespace gloam::studio
