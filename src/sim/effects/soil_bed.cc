#include "sim/effects/soil_bed.h"

#include "base/hash.h"

namespace gloam {
namespace {

constexpr int kMostIterations = 8;
constexpr double kConverged = 1e-4;  // of the change of velocity
constexpr double kNoWay = 1e-9;      // [m]
constexpr double kRestored = 0.1;    // of the energy of an impact, at most
constexpr double kMovesOn = 0.05;    // [m/s]
constexpr double kHeapWidth = 1.5;   // of a heap, over the sinkage beside it
constexpr int kFarthest = 64;        // cells to it

// Across a surface z = s0 x + s1 y: takes off what is along its normal.
inline void project(const double* slope, double* v) {
  const double n[3] = {-slope[0], -slope[1], 1}, along = dot3(n, v) / dot3(n, n);
  for (int a = 0; a < 3; ++a) v[a] -= along * n[a];
}

// Of a point of a body [m/s]; `motion`: of `point`, linear, then angular.
inline void velocity_at(const double* motion, const double* point, const double* p, double* v) {
  const double arm[3] = {p[0] - point[0], p[1] - point[1], p[2] - point[2]};
  cross3(motion + 3, arm, v);
  for (int a = 0; a < 3; ++a) v[a] += motion[a];
}

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

SoilBed::SoilBed(const SoilDescription& soil, const mjModel& model, std::span<const int> geoms)
    : soil_(soil),
      contacts_(soil, model, geoms),
      cells_(soil.cells()),
      answers_of_(static_cast<size_t>(model.nbody)),
      tracks_(soil) {
  pushes_.reserve(contacts_.most_touches());
  reactions_.reserve(geoms.size());
  for (const int geom : geoms) {
    const int body = model.geom_bodyid[geom];
    Answer& answer = answers_of_[static_cast<size_t>(body)];
    if (answer.count > 0) continue;
    answer.first = answers_.size();
    answer.count = static_cast<size_t>(chain_length(model, body));
    answers_.resize(answers_.size() + answer.count);
  }
}

void SoilBed::reset() {
  std::fill(cells_.begin(), cells_.end(), SoilCell{});
  for (Answer& answer : answers_of_) answer.step = 0;
  contacts_.reset();
  reactions_.clear();
  tracks_.reset();
}

bool SoilBed::take_over(const SoilBed& before) {
  const SoilDescription &a = soil_, &b = before.soil_;
  const bool same = a.name == b.name && a.nx == b.nx && a.ny == b.ny && a.x == b.x && a.y == b.y &&
                    a.size_x == b.size_x && a.size_y == b.size_y && a.level == b.level &&
                    a.rest == b.rest;
  if (!same) return false;
  cells_ = before.cells_;
  tracks_.take_over(before.tracks_);
  return true;
}

bool SoilBed::is_near(const mjModel& m, const mjData& d, int geom) const {
  const double *R = d.geom_xmat + 9 * geom, *box = m.geom_aabb + 6 * geom;
  double centre[3], half[3];
  mju_mulMatVec3(centre, R, box);
  mju_addTo3(centre, d.geom_xpos + 3 * geom);
  edges_around(R, box + 3, half);
  double bottom = soil_.level - soil_.depth;
  if (!soil_.rest.empty()) bottom = -1e10;  // nobody is below uneven ground
  return std::abs(centre[0] - soil_.x) < half[0] + soil_.size_x / 2 &&
         std::abs(centre[1] - soil_.y) < half[1] + soil_.size_y / 2 &&
         centre[2] - half[2] < soil_.level && centre[2] + half[2] > bottom;
}

uint64_t SoilBed::press(uint32_t step, const mjModel& m, const mjData& d,
                        std::span<const ColliderBottom* const> colliders, uint64_t hash) {
  contacts_.clear();
  for (const ColliderBottom* collider : colliders) {
    if (is_near(m, d, collider->geom())) contacts_.add(*collider);
  }
  contacts_.finish();
  int body = -1;
  double motion[6] = {};
  for (const SoilTouch& touch : contacts_.touches()) {
    if (touch.body != body) {
      body = touch.body;
      mj_objectVelocity(&m, &d, mjOBJ_XBODY, body, motion, 0);  // angular, then linear
    }
    const double twist[6] = {motion[3], motion[4], motion[5], motion[0], motion[1], motion[2]};
    double v[3];
    velocity_at(twist, d.xpos + 3 * body, touch.p, v);
    press_cell(step, m.opt.timestep, touch, v);
    const SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
    hash = hash_bytes(&cell, sizeof(cell), hash_bytes(&touch.cell, sizeof(touch.cell), hash));
  }
  return hash;
}

// What has happened since the last step.
void SoilBed::press_cell(uint32_t step, double dt, const SoilTouch& touch, const double* velocity) {
  SoilCell& cell = cells_[static_cast<size_t>(touch.cell)];
  const double modulus = soil_.strength.k_c / contacts_.widths()[static_cast<size_t>(touch.patch)] +
                         soil_.strength.k_phi;
  const SoilPressure now = soil_pressure(soil_.strength, cell, modulus, soil_.depth, touch.depth);
  if (now.yields) {
    cell.sinkage = static_cast<float>(touch.depth);
    cell.pressure = static_cast<float>(now.p);
    const double share = std::min(touch.area / (soil_.dx * soil_.dy), 1.0);
    const double left = touch.depth - now.p / cell.unloading(soil_.strength);
    const auto height = static_cast<float>(-left * share);
    const float lower = tracks_.height(touch.cell) - height;
    if (lower > 0) {
      tracks_.set_height(touch.cell, height);
      push_aside(touch, velocity, double{lower} * soil_.dx * soil_.dy * soil_.strength.aside);
    }
  }
  if (cell.touched != step || now.p <= 0) std::fill_n(cell.shear, 3, 0.0f);
  cell.touched = step + 1;
  if (now.p <= 0) return;
  double v[3];
  mju_copy3(v, velocity);
  project(touch.slope, v);
  const double speed = mju_norm3(v), way = speed * dt;
  if (way < kNoWay) return;
  const double share = -std::expm1(-way / soil_.strength.shear);
  for (int a = 0; a < 3; ++a) {
    const double shear = double{cell.shear[a]};
    cell.shear[a] = static_cast<float>(shear - (v[a] / speed + shear) * share);
  }
}

// What is displaced rises beside what displaces it: away from its middle, or, where it moves on, at
// its sides. That is seen and not felt.
void SoilBed::push_aside(const SoilTouch& touch, const double* velocity, double volume) {
  if (volume <= 0) return;
  const double* centre = contacts_.centre(touch.patch);
  double way[2] = {touch.p[0] - centre[0], touch.p[1] - centre[1]};
  const double speed = std::hypot(velocity[0], velocity[1]);
  if (speed > kMovesOn) {
    const double across[2] = {-velocity[1] / speed, velocity[0] / speed};
    const double side = way[0] * across[0] + way[1] * across[1] < 0 ? -1 : 1;
    way[0] = side * across[0], way[1] = side * across[1];
  }
  const double length = std::hypot(way[0], way[1]);
  if (length < kNoWay) return;
  // From cell to cell, out of what is touched, then over as many as the heap is wide.
  const double step = std::min(soil_.dx, soil_.dy);
  const int wide = std::clamp(static_cast<int>(std::ceil(kHeapWidth * touch.depth / step)), 2, 8);
  int left = wide;
  for (int i = 1; i <= kFarthest && left > 0; ++i) {
    const double x = touch.p[0] + way[0] / length * step * i - soil_.low_x();
    const double y = touch.p[1] + way[1] / length * step * i - soil_.low_y();
    if (x < 0 || y < 0 || x >= soil_.size_x || y >= soil_.size_y) return;
    const int cell = std::min(static_cast<int>(y / soil_.dy), soil_.ny - 1) * soil_.nx +
                     std::min(static_cast<int>(x / soil_.dx), soil_.nx - 1);
    if (contacts_.is_touched(cell)) continue;
    const double share = 2.0 * left / (wide * (wide + 1));
    tracks_.set_height(
        cell, tracks_.height(cell) + static_cast<float>(share * volume / soil_.dx / soil_.dy));
    --left;
  }
}

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
    double moved = 0, size = kNoWay;
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
    velocity_at(motion, point, touch.p, v);
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
    if (cell.sinkage <= 0) continue;
    const double p = double{cell.pressure};
    stored += touch.area * p * p / (2 * cell.unloading(soil_.strength));
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
  const SoilPressure now = soil_pressure(s, cell, modulus, soil_.depth, touch.depth - dt * sinking);
  if (now.p <= 0) return out;
  out.stiffness = touch.area * now.slope * dt;
  out.load = touch.area * now.p + out.stiffness * sinking;
  // Shear, over the true area.
  double across[3],
      shear[3] = {double{cell.shear[0]}, double{cell.shear[1]}, double{cell.shear[2]}};
  std::copy_n(v, 3, across);
  project(touch.slope, across);
  project(touch.slope, shear);
  const double steep = dot3(d, d), speed = std::sqrt(dot3(across, across));
  const double most = touch.area * std::sqrt(steep) * (s.cohesion + now.p * s.tan_friction);
  const double share = -std::expm1(-speed * dt / s.shear);
  out.across = most * (speed * dt > kNoWay ? share / speed : dt / s.shear);
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
