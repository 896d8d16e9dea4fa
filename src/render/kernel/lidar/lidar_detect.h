#pragma once
// A LiDAR's receiver: from the echoes of one pulse to the returns that it reports. Device-safe.

#include "base/rng.h"
#include "render/kernel/math/ray.h"
#include "world/media/medium_description.h"

namespace gloam {

/// Returns that a sensor reports.
enum class LidarReturns : uint8_t {
  kFirst,
  kStrongest,
  kLast,
  kDual,  ///< the strongest and the last; if that is the same, the second strongest
  kAll,   ///< by range, up to LidarOptics::most_returns
};

inline constexpr int kMostLidarReturns = 5;
inline constexpr int kMostFootprintRays = 32;

/// Optical properties of a surface at a LiDAR's wavelength.
struct LidarSurface {
  float diffuse = 1;      ///< factor on its red
  float retro = 0;        ///< coefficient of retroreflection [1/sr]
  float absorption = -1;  ///< inside glass [1/m]; -1 = as of red light
};

/// Particles of one size in a volume, as a LiDAR sees them.
struct LidarParticle {
  float number = 0;       ///< mean, where the volume is as dense as LidarParticles::density [1/m³]
  float backscatter = 0;  ///< differential cross-section straight back [m²/sr]
};

/// Echo of the particles in one cell of range (lidar::kCell).
struct LidarCell {
  float mean = 0;      ///< number of those in the beam that are seen one by one
  uint32_t first = 0;  ///< their first class
  float even = 0;      ///< volume backscattering coefficient of all others [1/(m sr)]
};

/// A volume of particles that are few enough to be met one by one.
struct LidarParticles {
  DeviceSpan<const LidarParticle> classes;  ///< from small to large; empty = a medium
  DeviceSpan<const LidarCell> cells;        ///< from the sensor to its range
  float density = 1;                        ///< at which their numbers count [kg/m³]
};

/// Optics and receiver of a LiDAR. Signals: see kernel/lidar/lidar.h.
struct LidarOptics {
  MediumBand band = MediumBand::k905nm;
  float min_range = 0.1f, max_range = 100;  ///< [m]
  Vec2f divergence;                         ///< full angles at 1/e², across and up [rad]
  Vec2f beam_size;                          ///< full widths at 1/e² where it leaves [m]
  int footprint_rays = 1;                   ///< 1 … kMostFootprintRays
  float receiver_diameter = 0;  ///< of its lens [m]; 0 = it sees all that the beam lights
  float receiver_offset = 0;    ///< of its axis from the beam's [m]
  float receiver_view = 0;      ///< full field of view of a detector [rad]
  /// Echoes closer together than this are one [m]: half the length of the pulse.
  float resolution = 0.3f;
  float threshold = 0;  ///< least signal that is reported [1/m²]
  LidarReturns returns = LidarReturns::kStrongest;
  int most_returns = 1;  ///< 1 … kMostLidarReturns
  /// Extinction over backscattering coefficient of each of the scene's volumes [sr]; 0 = by its
  /// phase function. Empty = all by their phase functions.
  DeviceSpan<const float> lidar_ratios;
  DeviceSpan<const LidarParticles> particles;  ///< of each volume; empty = all are media
  DeviceSpan<const uint8_t> hidden;            ///< by instance: beams pass it; empty = none
  DeviceSpan<const LidarSurface> surfaces;     ///< of each instance; empty = as their colours say
  // Noise: none without `noisy`.
  bool noisy = false;
  float range_sigma = 0;  ///< standard deviation of ranges at a signal without noise [m]
  float rise = 0;         ///< way of light in half the time that the pulse rises [m]
};

/// One return; part 0 comes from a medium.
struct LidarReturn {
  float range = 0;  ///< along the beam [m]; 0 = none
  float signal = 0;
  uint32_t part = 0;
};

/// Key of a beam's draws: the same whatever thread, packet or order it is traced in.
struct LidarKey {
  uint64_t seed = 0;
  uint64_t scan = 0;
  uint32_t beam = 0;
};

namespace lidar {

/// Signal over the noise's standard deviation at the threshold. The sheet of the OS1 (2018) gives
/// its precision down to a ratio of 12.
inline constexpr float kLeastRatio = 12;

GLOAM_HD Philox4 draw(const LidarKey& key, uint32_t stream, uint32_t index) {
  // One counter for the scan and one for the beam: 2^32 beams, and as many draws of each.
  return philox4x32(key.seed ^ (static_cast<uint64_t>(stream) << 32),
                    (static_cast<uint64_t>(key.beam) << 32) | index, key.scan);
}

/// Two independent normal draws (Box and Muller 1958, "A note on the generation of random normal
/// deviates").
GLOAM_HD Vec2f normal_pair(const Philox4& bits) {
  const float u = (static_cast<float>(bits.v[0] >> 8) + 0.5f) * 0x1p-24f;
  const float r = sqrtf(-2.0f * logf(u));
  float s, c;
  sincos_turn(uniform_float(bits.v[1]), &s, &c);
  return {r * c, r * s};
}

}  // namespace lidar

/// Echo of one pulse from one place.
struct LidarEcho {
  float range;  ///< [m]
  float signal;
  uint32_t part;
};

/// The echoes of one beam, by range.
class LidarEchoes {
 public:
  /// The weakest gives way where there is no room.
  GLOAM_HD void add(const LidarEcho& echo) {
    if (count_ == kMaxEchoes) {
      int weakest = 0;
      for (int i = 1; i < count_; ++i) {
        if (echoes_[i].signal < echoes_[weakest].signal) weakest = i;
      }
      if (!(echo.signal > echoes_[weakest].signal)) return;
      for (int i = weakest; i + 1 < count_; ++i) echoes_[i] = echoes_[i + 1];
      --count_;
    }
    int at = count_++;
    for (; at > 0 && echoes_[at - 1].range > echo.range; --at) echoes_[at] = echoes_[at - 1];
    echoes_[at] = echo;
  }
  /// Joins what the receiver cannot tell apart: a run of echoes within `resolution` of its first
  /// becomes one at their mean range by signal, of the part that sends back most.
  GLOAM_HD void join(float resolution) {
    int out = 0;
    for (int i = 0; i < count_;) {
      const float first = echoes_[i].range;
      float sum = 0, moment = 0, most = 0;
      uint32_t part = 0;
      for (; i < count_ && echoes_[i].range - first <= resolution; ++i) {
        sum += echoes_[i].signal;
        moment += (echoes_[i].range - first) * echoes_[i].signal;
        if (echoes_[i].signal > most) {
          most = echoes_[i].signal;
          part = echoes_[i].part;
        }
      }
      echoes_[out++] = {first + moment / sum, sum, part};
    }
    count_ = out;
  }
  GLOAM_HD int count() const { return count_; }
  GLOAM_HD LidarEcho& operator[](int i) { return echoes_[i]; }
  GLOAM_HD void resize(int count) { count_ = count; }

 private:
  static constexpr int kMaxEchoes = 64;
  LidarEcho echoes_[kMaxEchoes];
  int count_ = 0;
};

/// Returns that the receiver makes of the echoes of one beam: `out` takes optics.most_returns
/// returns,
/// those that are none last. With noise, amplitudes have a normal error of threshold / kLeastRatio,
/// and ranges one of
///   sigma² = range_sigma² + rise² / (signal / noise)
/// (Wehr and Lohr 1999, eq. 6; `rise` = 0.3 m fits the three figures of the OS1's sheet).
GLOAM_HD void detect(const LidarOptics& optics, const LidarKey& key, LidarEchoes* echoes,
                     LidarReturn* out) {
  for (int i = 0; i < optics.most_returns; ++i) out[i] = {};
  if (echoes->count() == 0) return;
  LidarEchoes& e = *echoes;
  e.join(optics.resolution);
  const float noise = optics.threshold / lidar::kLeastRatio;
  int count = 0;
  for (int i = 0; i < e.count(); ++i) {
    LidarEcho echo = e[i];
    if (optics.noisy) {
      const Vec2f n =
          lidar::normal_pair(lidar::draw(key, stream_id("lidar.noise"), static_cast<uint32_t>(i)));
      const float spread = sqr(optics.rise) * noise / echo.signal;
      echo.range += n.x * sqrtf(sqr(optics.range_sigma) + spread);
      echo.signal += n.y * noise;
    }
    if (!(echo.signal >= optics.threshold) || !(echo.signal > 0) || !(echo.range > 0)) continue;
    e[count++] = echo;
  }
  e.resize(count);
  if (count == 0) return;
  const auto take = [&](int from, int to) {
    out[to] = {e[from].range, e[from].signal, e[from].part};
  };
  const auto strongest_but = [&](int other) {
    int best = -1;
    for (int i = 0; i < count; ++i) {
      if (i != other && (best < 0 || e[i].signal > e[best].signal)) best = i;
    }
    return best;
  };
  switch (optics.returns) {
    case LidarReturns::kFirst:
      return take(0, 0);
    case LidarReturns::kStrongest:
      return take(strongest_but(-1), 0);
    case LidarReturns::kLast:
      return take(count - 1, 0);
    case LidarReturns::kDual: {
      const int strongest = strongest_but(-1);
      take(strongest, 0);
      const int other = strongest != count - 1 ? count - 1 : strongest_but(strongest);
      if (other >= 0 && optics.most_returns > 1) take(other, 1);
      return;
    }
    case LidarReturns::kAll:
      for (int i = 0; i < min(count, optics.most_returns); ++i) take(i, i);
  }
}

}  // namespace gloam
