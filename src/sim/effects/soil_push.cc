// What a bed does to bodies in a step: Newton's method for the wrench of its end.

#include "sim/effects/soil_bed.h"

#include "base/wave_math.h"

namespace gloam {
namespace {

constexpr int kMostIterations = 8;
constexpr double kConverged = 1e-3;  // of the change of velocity
constexpr double kStill = 1e-9;      // [m] or [m/s]
constexpr double kRestored = 0.1;    // of the energy of an impact, at most

// A x = b, (6 x 6), row by row; x in b's place. Gauss with pivots of rows.
void solve6(double* A, double* b) {
  for (int i = 0; i < 6; ++i) {
    int pivot = i;
    for (int r = i + 1; r < 6; ++r)
      if (std::abs(A[6 * r + i]) > std::abs(A[6 * pivot + i])) pivot = r;
    if (A[6 * pivot + i] == 0) return;
    if (pivot != i) {
      std::swap_ranges(A + 6 * i, A + 6 * i + 6, A + 6 * pivot);
      std::swap(b[i], b[pivot]);
    }
    for (int r = i + 1; r < 6; ++r) {
      const double f = A[6 * r + i] / A[6 * i + i];
      for (int c = i; c < 6; ++c) A[6 * r + c] -= f * A[6 * i + c];
      b[r] -= f * b[i];
    }
  }
  for (int i = 5; i >= 0; --i) {
    for (int c = i + 1; c < 6; ++c) b[i] -= A[6 * i + c] * b[c];
    b[i] /= A[6 * i + i];
  }
}

}  // namespace

void SoilBed::push(uint32_t step, const mjModel& m, mjData& d, ResponseSolver* solver) {
  reactions_.clear();
  const std::span<const SoilTouch> all = contacts_.touches();
  for (size_t from = 0, to = 0; from < all.size(); from = to) {
    while (to < all.size() && all[to].body == all[from].body) ++to;
    push_body(m, d, all.subspan(from, to - from), step, solver);
  }
}

void SoilBed::push_body(const mjModel& m, mjData& d, std::span<const SoilTouch> touches,
                        uint32_t step, ResponseSolver* solver) {
  const int body = touches.front().body;
  if (last_dof(m, body) < 0) return;
  double point[3] = {}, area = 0;
  for (const SoilTouch& touch : touches) {
    mju_addToScl3(point, touch.p, touch.area);
    area += touch.area;
  }
  mju_scl3(point, point, 1 / area);
  // As it would move without this bed: with all else as in the last step.
  Answer& answer = answers_of_[static_cast<size_t>(body)];
  const std::span<double> joints = std::span(answers_).subspan(answer.first, answer.count);
  const BodyResponse body_now =
      solver->solve(m, d, body, point, answer.step == step ? joints : std::span<double>{});
  const double dt = m.opt.timestep;
  double free[6], motion[6], change[6];
  mju_copy(free, body_now.velocity, 6);
  mju_addToScl(free, body_now.acceleration, dt, 6);
  mju_copy(motion, body_now.velocity, 6);
  double wrench[6] = {};
  pushes_.resize(touches.size());
  for (int i = 0; i < kMostIterations; ++i) {
    // wrench = force - matrix * motion, with motion = free + dt inverse * wrench.
    double force[6] = {}, matrix[36] = {}, system[36];
    for (size_t n = 0; n < touches.size(); ++n) {
      double arm[3];
      for (int a = 0; a < 3; ++a) arm[a] = touches[n].p[a] - point[a];
      pushes_[n] = push_of(touches[n], arm, motion, dt);
      if (pushes_[n].across > 0) add_push(pushes_[n], arm, force, matrix);
    }
    mju_mulMatMat(system, matrix, body_now.inverse, 6, 6, 6);
    mju_scl(system, system, dt, 36);
    for (int k = 0; k < 6; ++k) system[7 * k] += 1;
    mju_mulMatVec(wrench, matrix, free, 6, 6);
    mju_sub(wrench, force, wrench, 6);
    solve6(system, wrench);
    mju_mulMatVec(change, body_now.inverse, wrench, 6, 6);
    double moved = 0, size = kStill;
    for (int k = 0; k < 6; ++k) {
      const double now = free[k] + dt * change[k];
      moved = std::max(moved, std::abs(now - motion[k]));
      size = std::max(size, std::abs(now - body_now.velocity[k]));
      motion[k] = now;
    }
    if (moved < kConverged * size) break;
  }
  for (const double x : wrench)
    if (!std::isfinite(x)) return;
  const double share = limit_work(touches, free, change, dt, wrench);
  mju_scl(wrench, wrench, share, 6);
  add_wrench(m, d, body, wrench, wrench + 3, point);
  answer.step = step + 1;
  solver->accelerations(m, d, body, wrench, joints);
  react(touches, point, motion, share);
}

// What of the wrench is on which geom.
void SoilBed::react(std::span<const SoilTouch> touches, const double* point, const double* motion,
                    double share) {
  double load = 0;
  SoilReaction* now = nullptr;
  const auto finish = [&] {
    if (now != nullptr && load > 0) mju_scl3(now->p, now->p, 1 / load), mju_normalize3(now->normal);
    if (now != nullptr && load <= 0) reactions_.pop_back();
  };
  for (size_t n = 0; n < touches.size(); ++n) {
    const SoilTouch& touch = touches[n];
    const Push& push = pushes_[n];
    if (now == nullptr || now->geom != touch.geom) {
      finish();
      now = &reactions_.emplace_back();
      now->geom = touch.geom, now->body = touch.body;
      load = 0;
    }
    double v[3];
    soil_velocity_at(motion, point, touch.p, v);
    const double along = mju_dot3(push.d, v);
    const double pressing = push.load - push.stiffness * along;
    load += pressing;
    mju_addToScl3(now->p, touch.p, pressing);
    mju_addToScl3(now->normal, push.d, pressing);
    for (int a = 0; a < 3; ++a)
      now->force[a] += share * (push.f[a] - push.across * v[a] - push.along * along * push.d[a]);
  }
  finish();
}

// A body so light that a step takes it far through the ground must not be thrown out of it: the bed
// gives no more energy than it can have stored, nor than a share of what the body brings along.
// Returns the share of the wrench that it gives. `change`: inverse * wrench.
double SoilBed::limit_work(std::span<const SoilTouch> touches, const double* free,
                           const double* change, double dt, const double* wrench) const {
  double stored = 0;
  for (const SoilTouch& touch : touches) {
    const SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
    const double p = double{cell.pressure}, deepest = cell.sinkage_under(touch.fallen);
    if (p <= 0) continue;
    stored += touch.area * p * p / (2 * cell.unloading(soil_.strength, deepest));
  }
  const double by_motion = dt * mju_dot(wrench, free, 6);
  const double by_change = dt * dt / 2 * mju_dot(wrench, change, 6);
  if (by_change <= 0) return 1;
  const double brought = by_motion * by_motion / (4 * by_change);
  stored = std::min(stored, kRestored * brought);
  if (by_motion + by_change <= stored) return 1;
  const double share =
      (std::sqrt(by_motion * by_motion + 4 * by_change * stored) - by_motion) / (2 * by_change);
  return std::min(share, 1.0);
}

// Of a touch on its body, linear about `motion`, the body's at the step's end.
SoilBed::Push SoilBed::push_of(const SoilTouch& touch, const double* arm, const double* motion,
                               double dt) const {
  const SoilStrength& s = soil_.strength;
  const SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
  double v[3];
  cross3(motion + 3, arm, v);
  for (int a = 0; a < 3; ++a) v[a] += motion[a];
  // The pressure's direction, over an area seen from above, and so the sinkage's.
  Push out{.d = {-touch.slope[0], -touch.slope[1], 1}};
  const double* d = out.d;
  const double sinking = dot3(d, v);
  const double modulus = s.k_c / contacts_.widths()[static_cast<size_t>(touch.patch)] + s.k_phi;
  const SoilPressure now =
      soil_pressure(s, cell, modulus, depth_at(touch), touch.depth - dt * sinking);
  if (now.p <= 0) return out;
  out.stiffness = touch.area * now.slope * dt;
  out.load = touch.area * now.p + out.stiffness * sinking;
  // Shear, over the true area.
  double across[3],
      shear[3] = {double{cell.shear[0]}, double{cell.shear[1]}, double{cell.shear[2]}};
  std::copy_n(v, 3, across);
  project_along(touch.slope, across);
  project_along(touch.slope, shear);
  const double steep = dot3(d, d), speed = std::sqrt(dot3(across, across));
  const double most = touch.area * std::sqrt(steep) * (s.cohesion + now.p * s.tan_friction);
  const double share = 1 - exponential(-speed * dt / s.shear);
  out.across = most * (speed * dt > kStill ? share / speed : dt / s.shear);
  out.along = out.stiffness - out.across / steep;
  for (int a = 0; a < 3; ++a) out.f[a] = out.load * d[a] + most * (1 - share) * shear[a];
  return out;
}

// X' f and X' K X come to force and matrix, where X = (I, -[arm]) takes the body's motion to the
// touch's, and K = across I + along d d'.
void SoilBed::add_push(const Push& push, const double* arm, double* force, double* matrix) {
  double moment[3], w[6], square = dot3(arm, arm);
  cross3(arm, push.f, moment);
  for (int a = 0; a < 3; ++a) force[a] += push.f[a], force[3 + a] += moment[a], w[a] = push.d[a];
  cross3(arm, push.d, w + 3);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix[6 * i + j] += push.along * w[i] * w[j];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    matrix[7 * i] += push.across;
    for (int n = 0; n < 3; ++n)
      matrix[6 * (i + 3) + n + 3] += push.across * ((i == n ? square : 0) - arm[i] * arm[n]);
    // -[arm] at the right, [arm] below.
    matrix[6 * j + k + 3] += push.across * arm[i], matrix[6 * k + j + 3] -= push.across * arm[i];
    matrix[6 * (j + 3) + k] -= push.across * arm[i],
        matrix[6 * (k + 3) + j] += push.across * arm[i];
  }
}

}  // namespace gloam
