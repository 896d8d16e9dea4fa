#pragma once
// One bed of soil on the sim thread: what colliders do to its cells, and what it does to them.
//
// The pressure under a body depends on where the step will take it, along lines far too steep for
// an explicit step. So the wrench on each body is that of the step's end (implicit Euler): Newton's
// method with the inverse inertia of the body among its joints. After the idea of Chrono's soil
// contact model (Tasora et al. 2019).

#include "instant/contact_load.h"
#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/soil/soil_lanes.h"
#include "sim/effects/soil/soil_tracks.h"

namespace gloam {

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
  /// Adds the forces of the coming step to data.qfrc_applied. data.qLD is of the present. `work`:
  /// work of each body on the ground [J], to which that of the step is added; empty = nobody asks.
  void push(uint32_t step, const mjModel& model, mjData& data, ResponseSolver* solver,
            std::span<double> work = {});

  /// Loads of the last push(), by geoms.
  std::span<const ContactLoad> loads() const { return loads_; }

  SoilTracks& tracks() { return tracks_; }
  const SoilDescription& description() const { return soil_; }
  const std::vector<SoilCell>& cells() const { return cells_; }

 private:
  /// Response of the bed to a body in a step: accelerations of the joints that move it, stored in
  /// answers_.
  struct Answer {
    uint32_t step = 0;  // after the one it was for
    size_t first = 0, count = 0;
  };
  /// Contacts of a body.
  struct Body {
    int id = 0;
    double point[3] = {};         // point at which its motion is given [m]
    size_t first = 0, count = 0;  // touches
    size_t lanes = 0;             // the first of them; kSide touches each
  };
  struct Change {
    int cell = 0;
    SoilCell is;
  };
  void find_bodies();
  std::span<SoilLanes> lanes_of(const Body& body);
  void press_cell(uint32_t step, double dt, const SoilTouch& touch, const SoilLanes& lanes,
                  size_t i, const double* motion);
  void fill_in(uint32_t step, double dt, const SoilTouch& touch, SoilCell* cell) const;
  float lower_track(const SoilTouch& touch);
  void push_aside(const SoilTouch& touch, const double* velocity, double volume);
  enum class Slope { kDown, kUp };
  /// Neighbour that is too far below or above a cell for loose soil; none = nothing slides.
  struct Steep {
    int cell = -1;
    double excess = 0;  // [m]
  };
  static constexpr int kMostSlides = 256;  // from cell to cell, that one change sets off
  Steep steepest(int cell, Slope slope) const;
  void settle(int cell);
  void let_walls_fall();
  double push_body(const mjModel& model, mjData& data, const Body& body, uint32_t step,
                   ResponseSolver* solver);
  double limit_work(const Body& body, const double* free, const double* change, double dt,
                    const double* wrench);
  void react(const Body& body, const double* motion, double share);

  const SoilDescription& soil_;
  SoilContacts contacts_;
  std::vector<SoilCell> cells_;
  std::vector<Answer> answers_of_;  // answers of the last step, (nbody)
  std::vector<double> answers_;
  std::vector<double> moduli_;    // moduli of patches: k_c / b + k_phi [N/m^(n+2)]
  std::vector<Body> bodies_;      // bodies of this step
  std::vector<SoilLanes> lanes_;  // lanes of their touches
  std::vector<Change> changes_;   // changes of touched cells, scratch
  std::vector<int> unsettled_;    // cells that settle() has yet to look at, scratch
  std::vector<int> held_;         // cells that were touched in round_
  uint32_t round_ = 0;            // round of contacts_ that was seen last
  std::vector<ContactLoad> loads_;
  SoilTracks tracks_;
};

}  // namespace gloam
