#include "sensors/lidar/lidar_presets.h"

#include <cmath>

namespace gloam {
namespace {

constexpr float kFloatDegree = kPi / 180;
// Full width at 1/e² of a Gaussian beam over its full width at half maximum.
constexpr float kWidthOverFwhm = 1.6986f;
// Way of light in half the time that a pulse rises, 2 ns: with it the precision of the OS1's sheet
// (10, 3 and 1.5 cm at a signal over noise of 12, 100 and 250) is met within 4 mm.
constexpr float kPulseRiseLength = 0.3f;

std::vector<float> even_rings(int count, float lowest, float highest) {
  std::vector<float> elevations;
  for (int i = 0; i < count; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(count - 1);
    elevations.push_back((lowest + (highest - lowest) * share) * kFloatDegree);
  }
  return elevations;
}

/// The lower and the upper half fire in turns, each from below.
std::vector<float> interleaved_delays(int count, float step) {
  std::vector<float> delays;
  for (int ring = 0; ring < count; ++ring) {
    const int half = count / 2, place = ring < half ? 2 * ring : 2 * (ring - half) + 1;
    delays.push_back(static_cast<float>(place) * step);
  }
  return delays;
}

LidarOptics optics(float min_range, float max_range, double at_10_percent, Vec2f divergence_degrees,
                   float resolution, float range_sigma) {
  LidarOptics o;
  o.min_range = min_range;
  o.max_range = max_range;
  o.threshold = lidar_threshold(at_10_percent);
  o.divergence = divergence_degrees * kFloatDegree;
  o.resolution = resolution;
  o.range_sigma = range_sigma;
  o.rise = kPulseRiseLength;
  return o;
}

/// Beam [mm] and receiver of a sensor whose two lenses stand side by side. `view` [rad].
void set_apertures(Vec2f beam_mm, float lens_mm, float view, LidarOptics* o) {
  o->beam_size = beam_mm * 1e-3f;
  o->receiver_diameter = 1e-3f * lens_mm;
  o->receiver_offset = offset_of_lenses(*o);
  o->receiver_view = view;
}

LidarModel vlp_16() {
  LidarModel m;
  m.elevations = even_rings(16, -15, 15);
  m.delays = interleaved_delays(16, 2.304e-6f);
  m.columns = 1808;  // a firing sequence takes 55.296 us
  m.optics = optics(0.5f, 100, 35, {0.18f, 0.09f}, 1.0f, 0.03f);
  set_apertures({12.7f, 9.5f}, 30, 6e-3f, &m.optics);
  return m;
}

LidarModel hdl_32e() {
  LidarModel m;
  m.elevations = even_rings(32, -92.0f / 3, 32.0f / 3);
  m.delays = interleaved_delays(32, 1.152e-6f);
  m.columns = 2170;  // a firing sequence takes 46.08 us
  m.optics = optics(0.05f, 100, 35, {0.18f, 0.09f}, 1.0f, 0.02f);
  set_apertures({12.7f, 9.5f}, 30, 6e-3f, &m.optics);
  return m;
}

LidarModel hdl_64e() {
  LidarModel m;
  m.elevations = even_rings(32, -24.33f, -8.83f);
  const std::vector<float> upper = even_rings(32, -8.33f, 2);
  m.elevations.insert(m.elevations.end(), upper.begin(), upper.end());
  m.columns = 2083;
  m.optics = optics(0.9f, 120, 50, {0.115f, 0.115f}, 0.75f, 0.02f);
  set_apertures({10, 10}, 40, 6e-3f, &m.optics);
  return m;
}

LidarModel os1_64() {
  LidarModel m;
  m.elevations = even_rings(64, -16.6f, 16.6f);
  const float width = 0.13f * kWidthOverFwhm;
  m.optics = optics(0.8f, 120, 40, {width, width}, 0.5f, 0.005f);
  set_apertures({9.5f, 9.5f}, 20, 8e-3f, &m.optics);
  return m;
}

LidarModel os1_128() {
  LidarModel m = os1_64();
  m.elevations = even_rings(128, -22.5f, 22.5f);
  const float width = 0.18f * kWidthOverFwhm * kFloatDegree;
  m.optics.divergence = {width, width};
  return m;
}

LidarModel mid_40() {
  LidarModel m;
  m.pattern = LidarPatternKind::kRosette;
  m.width = m.height = 38.4f * kFloatDegree;
  m.points = 10000;  // 100 000 a second
  m.prism_hz[0] = 7294.0 / 60;
  m.prism_hz[1] = -4664.0 / 60;
  m.optics = optics(1.0f, 260, 90, {0.03f, 0.28f}, 0.5f, 0.02f);
  set_apertures({10, 10}, 25, 6e-3f, &m.optics);
  return m;
}

constexpr LidarPreset kPresets[] = {
    {"VLP-16", vlp_16},   {"HDL-32E", hdl_32e}, {"OS1-64", os1_64},
    {"HDL-64E", hdl_64e}, {"OS1-128", os1_128}, {"Mid-40", mid_40},
};

}  // namespace

const LidarPreset* find_lidar_preset(std::string_view name) {
  for (const LidarPreset& preset : kPresets) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

float offset_of_lenses(const LidarOptics& optics) {
  return 0.5f * optics.receiver_diameter + 0.25f * optics.beam_size.x;
}

float lidar_threshold(double range) {
  return range > 0 ? static_cast<float>(0.1 / (range * range)) : 0.0f;
}

}  // namespace gloam
