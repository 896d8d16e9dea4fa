#pragma once
// The ways of drops and flakes, of the droplets and crowns of their splashes and of what drips from
// edges, over a picture while the shutter is open.

#include <cmath>
#include <vector>

#include "base/rng.h"
#include "render/cpu/particles/particle_light.h"
#include "render/cpu/particles/particle_streaks.h"
#include "world/weather/rain_splash.h"
#include "world/weather/roof_drips.h"

namespace gloam {

inline constexpr float kNearestParticle = 0.1f;  ///< [m] a lens has a hood
inline constexpr float kFarthestParticle = 30;   ///< [m]

/// Way of one particle over the picture while the shutter is open.
struct Streak {
  Vec2f from, to;      ///< [px]
  float radius = 0;    ///< [px]
  float cover = 1;     ///< fraction of the exposure for which it covers a point of its way
  float distance = 0;  ///< [m]
  Vec3f light;         ///< that it sends to the camera [cd/m²]
  bool soft = false;   ///< thinner towards its edge
};

/// Projects points at times of the shutter.
class Projector {
 public:
  explicit Projector(const CameraView32& camera) : camera_(camera) {
    X_CW_ = inverse(camera.pose.X_WC_open);
  }
  bool project(Vec3f p_W, float time, Vec2f* uv) const {
    if (!camera_.pose.keys.empty())
      return gloam::project(camera_, camera_pose_at(camera_.pose, time), p_W, uv);
    const Vec3f p = transform_point(X_CW_, p_W);
    if (!camera_.orthographic && !camera_.is_pinhole()) {
      float x, y;
      if (!lens_project(camera_.lens, p.x, -p.y, -p.z, &x, &y)) return false;
      *uv = {camera_.cx + camera_.fx * x, camera_.cy + camera_.fy * y};
      return true;
    }
    if (!camera_.orthographic && p.z > -1e-3f) return false;
    const float s = camera_.orthographic ? 1.0f : -1.0f / p.z;
    *uv = {camera_.cx + camera_.fx * p.x * s, camera_.cy - camera_.fy * p.y * s};
    return true;
  }

 private:
  const CameraView32& camera_;
  Affine3f X_CW_;
};

/// The particles of one class in their own frame, which falls with them: cells of a lattice, each
/// with draws of its own.
struct Lattice {
  const ParticleSet& set;
  const ParticleClass& kind;
  uint32_t row = 0;
  float cell = 1;  ///< [m]

  /// Position of the frame's origin at `time` [m].
  void origin(double time, double p[3]) const {
    const Vec3 gusts = set.gusts != nullptr ? set.gusts->way(time, kind.lag()) : Vec3{};
    p[0] = static_cast<double>(set.wind.x) * time + gusts.x;
    p[1] = static_cast<double>(set.wind.y) * time + gusts.y;
    p[2] = -static_cast<double>(kind.fall_speed) * time + gusts.z;
  }
  Vec3f velocity(double time) const {
    const Vec3 gusts = set.gusts != nullptr ? set.gusts->carry(time, kind.lag()) : Vec3{};
    return set.wind + Vec3f{static_cast<float>(gusts.x), static_cast<float>(gusts.y),
                            static_cast<float>(gusts.z) - kind.fall_speed};
  }
};

struct Particle {
  ParticleKind kind;
  float diameter;  ///< [m]
  Vec3f velocity;  ///< [m/s]
};

class StreakFinder {
 public:
  StreakFinder(const ParticleView& view, const Film& film, const AmbientCube& around,
               const BlurredPicture& blurred);

  /// Distance beyond which a particle is too small to be rendered [m].
  float reach(float diameter) const;
  void find(const Lattice& lattice, std::vector<Streak>* out) const;
  /// Splashes where drops of class `row` have landed.
  void find_splashes(const ParticleSet& set, uint32_t row, std::vector<Streak>* out) const;
  /// Drips from edges, and their splashes.
  void find_drips(uint64_t seed, std::vector<Streak>* out) const;

 private:
  struct Cell {
    int64_t i, j, k;
  };
  /// Middle of the exposure [s].
  double middle() const {
    return view_.opens + view_.seconds * static_cast<double>(view_.camera.shutter.length) / 2;
  }
  bool is_open(Vec3f p, float tolerance) const {
    return view_.weather.shelter->view().open_above(p, tolerance) > 0.5f;
  }
  void look_into(const Lattice& lattice, Cell at, const double origin[3], Vec3f velocity, float far,
                 std::vector<Streak>* out) const;
  void land(const ParticleClass& kind, const Splash& splash, float far,
            std::vector<Streak>* out) const;
  void add_splash(const ParticleClass& kind, const Splash& splash, Vec3f ground, float far,
                  std::vector<Streak>* out) const;
  void add_crown(const Crown& crown, const Splash& splash, Vec3f ground, float far,
                 std::vector<Streak>* out) const;
  bool find_tip(const DripEdge& edge, float along, Vec3f* tip) const;
  void add_drips(const DripEdge& edge, uint64_t seed, std::vector<Streak>* out) const;
  /// `p`: where the particle is in the middle of the exposure.
  void add(const Particle& particle, Vec3f p, float far, const Philox4& bits,
           std::vector<Streak>* out) const;
  /// Way down from a point to what is below it [m]; false where nothing is.
  bool way_down(Vec3f from, float* way) const;
  float blur_at(float distance) const;
  bool is_in_picture(const Streak& s) const;
  Vec3f light_of(ParticleKind kind, Vec3f p, Vec2f uv, const Philox4& bits) const;

  const ParticleView& view_;
  const Film& film_;
  const AmbientCube& around_;
  const BlurredPicture& blurred_;
  const Projector projector_;
  Vec3f eye_, axis_;
  float half_angle_ = 0;
};

inline float way_length(Vec2f v) { return std::sqrt(v.x * v.x + v.y * v.y); }

}  // namespace gloam
