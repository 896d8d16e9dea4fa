#include "sim/effects/snow/snow_shedding.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/hash.h"
#include "sim/effects/bodies/body_forces.h"
#include "sim/effects/shared_version.h"
#include "world/weather/fallen_snow.h"

namespace gloam {
namespace {

constexpr Rational kUpdateRate{50, 1};  // [Hz]
constexpr double kDegree = std::numbers::pi / 180;
constexpr double kBreaks = 15 * kDegree, kHolds = 7.5 * kDegree;
constexpr double kSlideTime = 0.3;  // [s]
constexpr int kFirstVersions = 8;   // of what Snapshots hold

// Depth on level ground at the start [m]. Snow of a material has none: any will do.
double depth_of(const Scene& scene) {
  const double fallen = scene.weather ? scene.weather->snow_cover.value_or(0) : 0;
  const bool painted = std::any_of(scene.materials.begin(), scene.materials.end(),
                                   [](const MaterialOptions& m) { return m.snow.value_or(0) > 0; });
  constexpr double kPainted = 0.05;
  return painted ? std::max(fallen, kPainted) : fallen;
}

double reach_of(const mjModel& m, int body) {
  double reach = 0;
  const int first = m.body_geomadr[body];
  for (int geom = first; geom < first + m.body_geomnum[body]; ++geom)
    reach = std::max(reach, mju_norm3(m.geom_pos + 3 * geom) + m.geom_rbound[geom]);
  return reach;
}

// Angle between two attitudes [rad].
double turn_between(const double* A, const double* B) {
  double trace = 0;
  for (int i = 0; i < 9; ++i) trace += A[i] * B[i];
  return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0));
}

}  // namespace

Result<std::unique_ptr<Effect>> SnowShedding::make(const EffectParts& parts) {
  const Scene& scene = parts.world->scene;
  const double depth = depth_of(scene), growth = scene.weather ? snow_growth(*scene.weather) : 0;
  if (!(depth + growth > 0)) return std::unique_ptr<Effect>();
  std::unique_ptr<SnowShedding> made(new SnowShedding(parts, depth, growth));
  if (made->covers_.empty()) return std::unique_ptr<Effect>();
  return std::unique_ptr<Effect>(std::move(made));
}

SnowShedding::SnowShedding(const EffectParts& parts, double depth, double growth)
    : schedule_(StepSchedule::at_most(kUpdateRate, parts.timestep)),
      timestep_(parts.timestep.value()),
      start_(depth),
      growth_(growth) {
  const mjModel& m = parts.model;
  for (int body = 1; body < static_cast<int>(m.nbody); ++body) {
    if (last_dof(m, body) < 0 && m.body_mocapid[m.body_rootid[body]] < 0) continue;
    Cover& cover = covers_.emplace_back();
    cover.body = body;
    cover.reach = reach_of(m, body);
  }
  for (int i = 0; i < kFirstVersions; ++i)
    pool_.push_back(std::make_shared<std::vector<float>>(static_cast<size_t>(m.nbody), 1.0f));
}

void SnowShedding::reset(const EffectContext&) {
  tick_ = -1;
  level_ = start_;
  for (Cover& cover : covers_) cover.ticks = 0, cover.slides = 0, cover.depth = start_;
  shown_.reset();
}

void SnowShedding::take_over(const EffectContext& at, Effect*) {
  reset(at);
  tick_ = at.step;
  level_ = start_ + growth_ * static_cast<double>(at.step) * timestep_;
  for (Cover& cover : covers_) cover.depth = level_;
}

void SnowShedding::advance(const EffectContext& at) {
  const int64_t due = schedule_.step_of(schedule_.first_at_or_after(at.step));
  if (due != at.step || at.step == tick_) return;
  const double dt = static_cast<double>(at.step - std::max<int64_t>(tick_, 0)) * timestep_;
  tick_ = at.step;
  level_ += growth_ * dt;
  uint64_t digest = 0;
  for (Cover& cover : covers_) {
    cover.depth += growth_ * dt;
    look(at.model, at.data, dt, &cover);
    digest = hash_bytes(&cover.depth, sizeof(cover.depth), digest);
  }
  at.hash = hash_bytes(&digest, sizeof(digest), at.hash);
  show();
}

// Snow that is left while it slides comes to lie as the body is now.
void SnowShedding::slide(double tilt, const double* up, double dt, Cover* cover) {
  if (tilt > (cover->slides > 0 ? kHolds : kBreaks)) cover->slides = kSlideTime;
  if (!(cover->slides > 0)) return;
  cover->slides -= dt;
  const double keep = std::exp(-dt / kSlideTime);
  cover->depth *= keep;
  for (int a = 0; a < 3; ++a) cover->rest[a] += (up[a] - cover->rest[a]) * (1 - keep);
  mju_normalize3(cover->rest);
}

void SnowShedding::look(const mjModel& m, const mjData& d, double dt, Cover* cover) const {
  const double *p = d.xpos + 3 * cover->body, *R = d.xmat + 9 * cover->body;
  const double g = mju_norm3(m.opt.gravity);
  if (!(g > 0)) return;
  double up_W[3], up[3], spin = 0;
  for (int a = 0; a < 3; ++a) up_W[a] = -m.opt.gravity[a] / g;
  if (cover->ticks > 0 && dt > 0) spin = turn_between(R, cover->R) / dt;
  if (cover->ticks > 1 && dt > 0) {
    for (int a = 0; a < 3; ++a)
      up_W[a] += (p[a] - 2 * cover->p[0][a] + cover->p[1][a]) / (dt * dt * g);
  }
  mju_mulMatTVec3(up, R, up_W);
  mju_normalize3(up);
  if (cover->ticks == 0) std::copy_n(up, 3, cover->rest);
  const double tilt = std::acos(std::clamp(dot3(up, cover->rest), -1.0, 1.0));
  slide(tilt + std::atan(spin * spin * cover->reach / g), up, dt, cover);
  std::copy_n(cover->p[0], 3, cover->p[1]);
  std::copy_n(p, 3, cover->p[0]);
  std::copy_n(R, 9, cover->R);
  cover->ticks = std::min(cover->ticks + 1, 2);
}

// A new version where anything has changed to the eye.
void SnowShedding::show() {
  constexpr float kSeen = 0.004f;
  const auto left = [this](const Cover& cover) {
    return level_ > 0 ? static_cast<float>(cover.depth / level_) : 1.0f;
  };
  const bool is_same = std::all_of(covers_.begin(), covers_.end(), [&](const Cover& cover) {
    const float before = shown_ ? (*shown_)[static_cast<size_t>(cover.body)] : 1.0f;
    return std::abs(left(cover) - before) < kSeen;
  });
  if (is_same) return;
  auto free = std::find_if(pool_.begin(), pool_.end(), is_free<std::vector<float>>);
  if (free == pool_.end()) {  // readers hold all
    pool_.push_back(std::make_shared<std::vector<float>>(*pool_.front()));
    free = pool_.end() - 1;
  }
  for (const Cover& cover : covers_) (**free)[static_cast<size_t>(cover.body)] = left(cover);
  shown_ = *free;
}

void SnowShedding::publish(int64_t, EffectOutputs* out) { out->snow_left = shown_; }

}  // namespace gloam
