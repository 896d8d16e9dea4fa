#pragma once
// One bed of soil on the sim thread: what colliders do to its cells, and what it does to them.
//
// The pressure under a body depends on where the step will take it, along lines far too steep for
// an explicit step. So the wrench on each body is that of the step's end (implicit Euler): Newton's
// method with the inverse inertia of the body among its joints. After the idea of Chrono's soil
// contact model (Tasora et al. 2019).

#include "sim/effects/body_forces.h"
#include "sim/effects/soil_contact.h"
#include "sim/effects/soil_law.h"
#include "sim/effects/soil_tracks.h"
#include "sim/soil_reaction.h"

namespace gloam {

/// Across a surface z = s0 x + s1 y: takes off what is along its normal.
inline void project_along(const double* slope, double* v) {
  const double n[3] = {-slope[0], -slope[1], 1}, along = dot3(n, v) / dot3(n, n);
  for (int a = 0; a < 3; ++a) v[a] -= along * n[a];
}

/// Of a point of a body [m/s]; `motion`: of `point`, linear, then angular.
inline void soil_velocity_at(const double* motion, const double* point, const double* p,
                             double* v) {
  const double arm[3] = {p[0] - point[0], p[1] - point[1], p[2] - point[2]};
  cross3(motion + 3, arm, v);
  for (int a = 0; a < 3; ++a) v[a] += motion[a];
}

class SoilBed {
 public:
  /// `geoms`: all that may touch it.
  SoilBed(const SoilDescription& soil, const mjModel& model, std::span<const int> geoms);

  void reset();
  /// Goes on with the cells of another bed, if that is one of the same name, place and grid.
  bool take_over(const SoilBed& before);

  /// Does a collider's box reach into the bed at data.time?
  bool is_near(const mjModel& model, const mjData& data, int geom) const;

  /// Finds what `colliders` touch at the beginning of step `step`, in order of geoms, and what that
  /// does to the ground; their poses are set. The hash goes in and comes out with it.
  uint64_t press(uint32_t step, const mjModel& model, const mjData& data,
                 std::span<const ColliderBottom* const> colliders, uint64_t hash);
  /// Adds the forces of the coming step to data.qfrc_applied. data.qLD is of the present.
  void push(uint32_t step, const mjModel& model, mjData& data, ResponseSolver* solver);

  /// Of the last push(), by geoms.
  std::span<const SoilReaction> reactions() const { return reactions_; }

  SoilTracks& tracks() { return tracks_; }
  const SoilDescription& description() const { return soil_; }
  const std::vector<SoilCell>& cells() const { return cells_; }

 private:
  /// What the bed does to a body in a step: accelerations of the joints that move it, which stand
  /// in answers_.
  struct Answer {
    uint32_t step = 0;  // after the one it was for
    size_t first = 0, count = 0;
  };
  /// Force of a touch at velocities u of its point: f - across u - along d (d u).
  struct Push {
    double d[3] = {}, f[3] = {};     // where the ground presses to; [N]
    double across = 0, along = 0;    // [N s/m]
    double load = 0, stiffness = 0;  // pressing at no velocity [N], less by it [N s/m]
  };
  void press_cell(uint32_t step, double dt, const SoilTouch& touch, const double* velocity);
  void fill_in(uint32_t step, double dt, const SoilTouch& touch, SoilCell* cell) const;
  float lower_track(const SoilTouch& touch);
  void push_aside(const SoilTouch& touch, const double* velocity, double volume);
  void slide(int cell);
  void push_body(const mjModel& model, mjData& data, std::span<const SoilTouch> touches,
                 uint32_t step, ResponseSolver* solver);
  double limit_work(std::span<const SoilTouch> touches, const double* free, const double* change,
                    double dt, const double* wrench) const;
  Push push_of(const SoilTouch& touch, const double* arm, const double* motion, double dt) const;
  static void add_push(const Push& push, const double* arm, double* force, double* matrix);
  void react(std::span<const SoilTouch> touches, const double* point, const double* motion,
             double share);

  SoilDepth depth_at(const SoilTouch& touch) const {
    const auto cell = static_cast<size_t>(touch.cell);
    return {soil_.share_of(cell) * soil_.depth + touch.fallen, touch.fallen};
  }

  const SoilDescription& soil_;
  SoilContacts contacts_;
  std::vector<SoilCell> cells_;
  std::vector<Answer> answers_of_;  // of the last step, (nbody)
  std::vector<double> answers_;
  std::vector<Push> pushes_;  // room, of the touches of a body
  std::vector<SoilReaction> reactions_;
  SoilTracks tracks_;
};

}  // namespace gloam
