// Forces of a bed on bodies in a step: Newton's method for the wrench at the step's end.

#include "sim/effects/soil/soil_bed.h"

namespace gloam {
namespace {

constexpr int kMostIterations = 8;
constexpr double kConvergenceTolerance = 2e-2;  // fraction of the change of velocity
constexpr double kLeastSpeed = 1e-9;            // [m/s], [rad/s]
constexpr double kRestored = 0.1;               // fraction of the energy of an impact, at most

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
    const double per = 1 / A[7 * i];
    for (int r = i + 1; r < 6; ++r) {
      const double f = A[6 * r + i] * per;
      for (int c = i; c < 6; ++c) A[6 * r + c] -= f * A[6 * i + c];
      b[r] -= f * b[i];
    }
  }
  for (int i = 5; i >= 0; --i) {
    for (int c = i + 1; c < 6; ++c) b[i] -= A[6 * i + c] * b[c];
    b[i] /= A[6 * i + i];
  }
}

// Sums over touches: X' f and X' K X, where X = (I, -[arm]) takes the body's motion to the touch's,
// and K = across I + along d d'. Symmetric matrices hold the upper triangle, row by row.
struct Sums {
  static constexpr size_t kSide = SoilLanes::kSide;
  enum { kForce = 0, kAcross = 6, kFirst = 7, kSecond = 10, kAlong = 16, kCount = 37 };
  using Lanes = double[kSide];
  Lanes lanes[kCount] = {};

  void add(const SoilLanes& l) {
    Lanes w[6], ca[3], moment[3];  // w: d and arm x d
    for (size_t i = 0; i < kSide; ++i) {
      const double a[3] = {l.arm[0][i], l.arm[1][i], l.arm[2][i]};
      const double f[3] = {l.f[0][i], l.f[1][i], l.f[2][i]};
      const double x = l.slope[0][i], y = l.slope[1][i];
      w[0][i] = -x, w[1][i] = -y, w[2][i] = 1;
      w[3][i] = a[1] + a[2] * y, w[4][i] = -a[2] * x - a[0], w[5][i] = a[1] * x - a[0] * y;
      for (int n = 0; n < 3; ++n) ca[n][i] = l.across[i] * a[n];
      moment[0][i] = a[1] * f[2] - a[2] * f[1];
      moment[1][i] = a[2] * f[0] - a[0] * f[2];
      moment[2][i] = a[0] * f[1] - a[1] * f[0];
    }
    // The loop over lanes inside: what has a number of its own then stands in a register.
    int to = kSecond;
    for (int n = 0; n < 3; ++n) {
      for (size_t i = 0; i < kSide; ++i) {
        lanes[kForce + n][i] += l.f[n][i], lanes[kForce + 3 + n][i] += moment[n][i];
        lanes[kFirst + n][i] += ca[n][i];
      }
      for (int k = n; k < 3; ++k, ++to)
        for (size_t i = 0; i < kSide; ++i) lanes[to][i] += ca[n][i] * l.arm[k][i];
    }
    for (size_t i = 0; i < kSide; ++i) lanes[kAcross][i] += l.across[i];
    for (int n = 0; n < 6; ++n) {
      Lanes part;
      for (size_t i = 0; i < kSide; ++i) part[i] = l.along[i] * w[n][i];
      for (int k = n; k < 6; ++k, ++to)
        for (size_t i = 0; i < kSide; ++i) lanes[to][i] += part[i] * w[k][i];
    }
  }

  // force - matrix * motion.
  void finish(double* force, double (&matrix)[6][6]) const {
    double sum[kCount];
    for (int n = 0; n < kCount; ++n) {
      const double* l = lanes[n];
      sum[n] = ((l[0] + l[1]) + (l[2] + l[3])) + ((l[4] + l[5]) + (l[6] + l[7]));
    }
    std::copy_n(sum + kForce, 6, force);
    const double *upper = sum + kAlong, *a = sum + kFirst, *aa = sum + kSecond, c = sum[kAcross];
    for (int n = 0; n < 6; ++n)
      for (int k = n; k < 6; ++k) matrix[n][k] = *upper++;
    for (int n = 0; n < 3; ++n) matrix[n][n] += c;
    matrix[1][5] += a[0], matrix[2][4] -= a[0];
    matrix[2][3] += a[1], matrix[0][5] -= a[1];
    matrix[0][4] += a[2], matrix[1][3] -= a[2];
    // aa: xx xy xz yy yz zz.
    matrix[3][3] += aa[3] + aa[5], matrix[4][4] += aa[0] + aa[5], matrix[5][5] += aa[0] + aa[3];
    matrix[3][4] -= aa[1], matrix[3][5] -= aa[2], matrix[4][5] -= aa[4];
    for (int n = 0; n < 6; ++n)
      for (int k = 0; k < n; ++k) matrix[n][k] = matrix[k][n];
  }
};

}  // namespace

void SoilBed::push(uint32_t step, const mjModel& m, mjData& d, ResponseSolver* solver,
                   std::span<double> work) {
  loads_.clear();
  for (const Body& body : bodies_) {
    if (last_dof(m, body.id) < 0) continue;
    const double done = push_body(m, d, body, step, solver);
    if (!work.empty()) work[static_cast<size_t>(body.id)] += done;
  }
}

// Returns the work that the body does on the ground in the step [J].
double SoilBed::push_body(const mjModel& m, mjData& d, const Body& body, uint32_t step,
                          ResponseSolver* solver) {
  const std::span<SoilLanes> lanes = lanes_of(body);
  for (size_t n = 0; n < body.count; ++n) {
    const SoilTouch& touch = contacts_.touches()[body.first + n];
    lanes[n / SoilLanes::kSide].set(n % SoilLanes::kSide, cells_[static_cast<size_t>(touch.cell)],
                                    touch.fallen);
  }
  for (SoilLanes& four : lanes) four.find_unloading(soil_.strength);
  // As it would move without this bed: with all else as in the last step.
  Answer& answer = answers_of_[static_cast<size_t>(body.id)];
  const std::span<double> joints = std::span(answers_).subspan(answer.first, answer.count);
  const BodyResponse now =
      solver->solve(m, d, body.id, body.point, answer.step == step ? joints : std::span<double>{});
  const double dt = m.opt.timestep;
  double free[6], motion[6], change[6], wrench[6];
  for (int k = 0; k < 6; ++k) {
    free[k] = now.velocity[k] + dt * now.acceleration[k];
    motion[k] = now.velocity[k];
  }
  for (int i = 0; i < kMostIterations; ++i) {
    Sums sums;
    for (SoilLanes& four : lanes) {
      four.find_forces(soil_.strength, motion, dt);
      sums.add(four);
    }
    // motion = free + dt inverse * wrench.
    double matrix[6][6], system[36] = {};
    sums.finish(wrench, matrix);
    for (int r = 0; r < 6; ++r) {
      double* row = system + 6 * r;
      for (int k = 0; k < 6; ++k) {
        wrench[r] -= matrix[r][k] * free[k];
        const double part = dt * matrix[r][k];
        for (int c = 0; c < 6; ++c) row[c] += part * now.inverse[6 * k + c];
      }
      row[r] += 1;
    }
    solve6(system, wrench);
    double moved = 0, size = kLeastSpeed;
    for (int k = 0; k < 6; ++k) {
      change[k] = 0;
      for (int c = 0; c < 6; ++c) change[k] += now.inverse[6 * k + c] * wrench[c];
      const double is = free[k] + dt * change[k];
      moved = std::max(moved, std::abs(is - motion[k]));
      size = std::max(size, std::abs(is - now.velocity[k]));
      motion[k] = is;
    }
    if (moved < kConvergenceTolerance * size) break;
  }
  for (const double x : wrench)
    if (!std::isfinite(x)) return 0;
  const double share = limit_work(body, free, change, dt, wrench);
  for (double& x : wrench) x *= share;
  add_wrench(m, d, body.id, wrench, wrench + 3, body.point);
  answer.step = step + 1;
  solver->accelerations(m, d, body.id, wrench, joints);
  react(body, motion, share);
  // An even force does its work at the mean of the velocities before and after the step.
  double done = 0;
  for (int k = 0; k < 6; ++k) {
    const double after = free[k] + share * (motion[k] - free[k]);
    done -= dt / 2 * wrench[k] * (now.velocity[k] + after);
  }
  return done;
}

// Splits the wrench among the geoms.
void SoilBed::react(const Body& body, const double* motion, double share) {
  const std::span<const SoilTouch> touches = contacts_.touches().subspan(body.first, body.count);
  const std::span<const SoilLanes> lanes = lanes_of(body);
  double load = 0;
  ContactLoad* now = nullptr;
  const auto finish = [&] {
    if (now != nullptr && load > 0) mju_scl3(now->p, now->p, 1 / load), mju_normalize3(now->normal);
    if (now != nullptr && load <= 0) loads_.pop_back();
  };
  for (size_t n = 0; n < touches.size(); ++n) {
    const SoilTouch& touch = touches[n];
    const SoilLanes& l = lanes[n / SoilLanes::kSide];
    const size_t i = n % SoilLanes::kSide;
    if (now == nullptr || now->geom != touch.geom) {
      finish();
      now = &loads_.emplace_back();
      now->geom = touch.geom, now->body = touch.body;
      load = 0;
    }
    const double arm[3] = {l.arm[0][i], l.arm[1][i], l.arm[2][i]};
    const double d[3] = {-touch.slope[0], -touch.slope[1], 1};
    double v[3];
    cross3(motion + 3, arm, v);
    for (int a = 0; a < 3; ++a) v[a] += motion[a];
    const double along = dot3(d, v), pressing = l.load[i] - l.stiffness[i] * along;
    load += pressing;
    now->depth = std::max(now->depth, touch.depth);
    for (size_t a = 0; a < 3; ++a) {
      now->p[a] += pressing * touch.p[a];
      now->normal[a] += pressing * d[a];
      now->force[a] += share * (l.f[a][i] - l.across[i] * v[a] - l.along[i] * along * d[a]);
    }
  }
  finish();
}

// A body so light that a step takes it far through the ground must not be thrown out of it: the bed
// gives no more energy than it can have stored, nor than a fraction of what the body brings along.
// Returns the fraction of the wrench that it gives. `change`: inverse * wrench.
double SoilBed::limit_work(const Body& body, const double* free, const double* change, double dt,
                           const double* wrench) {
  double by_motion = 0, by_change = 0;
  for (int k = 0; k < 6; ++k) {
    by_motion += dt * wrench[k] * free[k];
    by_change += dt * dt / 2 * wrench[k] * change[k];
  }
  // A response that takes energy needs no further check.
  if (by_change <= 0 || by_motion + by_change <= 0) return 1;
  double stored = 0;
  for (const SoilLanes& l : lanes_of(body)) {
    for (size_t i = 0; i < SoilLanes::kSide; ++i) {
      if (l.pressure[i] > 0)
        stored += l.area[i] * l.pressure[i] * l.pressure[i] / (2 * l.unloading[i]);
    }
  }
  const double brought = by_motion * by_motion / (4 * by_change);
  stored = std::min(stored, kRestored * brought);
  if (by_motion + by_change <= stored) return 1;
  const double share =
      (std::sqrt(by_motion * by_motion + 4 * by_change * stored) - by_motion) / (2 * by_change);
  return std::min(share, 1.0);
}

}  // namespace gloam
