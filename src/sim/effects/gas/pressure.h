#pragma once
// Pressure makes the divergence what it should be: conjugate gradients on Poisson's equation,
// preconditioned by multigrid, begun with the last step's solution.

#include "sim/effects/gas/multigrid.h"
#include "sim/effects/gas/openings.h"

namespace gloam::gas {

/// Share of the divergence's error that may stay.
inline constexpr double kTolerance = 6e-5;
inline constexpr int kMostIterations = 60;

struct Projection {
  int iterations = 0;
  double before = 0, after = 0;  ///< L2 norms over cells of the divergence's error [1/s]
};

class Pressure {
 public:
  static uint64_t bytes(uint64_t cells) { return Multigrid::bytes(cells) + cells * 4 * 6; }

  explicit Pressure(const Shape& shape);
  /// Multigrid, whose finest level is written before update().
  Multigrid& multigrid() { return multigrid_; }
  /// Open or closed; ghosts' faces that are no sides of the box: closed.
  Faces<const float> open() const { return multigrid_.finest().weight; }

  /// Changes `velocity` by `share` (of cells and ghosts, at most 1) of what the last solution did
  /// to it. Done before velocity is carried along, half of the pressure acts at the beginning of a
  /// way and half at its end: of second order in time, so that air keeps its energy on its way
  /// around a bend (compare Zehnder, Narain and Thomaszewski 2018).
  void push(const Faces<float>& velocity, const Field& share);
  /// Changes `velocity` at open faces, by the other half. `wanted`: divergence times `dt`, as kHeat
  /// grew; spaces without an opening get what their walls' motion leaves room for.
  Projection project(const Openings& openings, const Faces<float>& velocity, const float* wanted,
                     float voxel, float dt);

  /// Last step's, for the next; part of the state.
  Field& solution() { return x_; }
  const Field& solution() const { return x_; }

 private:
  template <class Change>
  void subtract(const Faces<float>& velocity, const Change& change);
  double dot(const Field& a, const Field& b);
  void set_target(const Openings& openings, const Faces<const float>& velocity, const float* wanted,
                  float scale);

  Shape shape_;
  Multigrid multigrid_;
  Field x_, target_, residual_, z_, p_, ap_;
  std::vector<double> partial_, space_sum_, space_count_, space_faces_;
};

}  // namespace gloam::gas
