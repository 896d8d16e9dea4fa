// Probes of light at a place, and of the exposure of a camera.

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/lens.h"
#include "geometry/mesh/single.h"
#include "sensors/camera/camera_models.h"
#include "sensors/probe/probe_families.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr double kNoReading = std::numeric_limits<double>::quiet_NaN();

int camera_row(const RenderDescription& description, const std::string& name) {
  const auto found = std::ranges::find(description.cameras, name, &CameraDescription::name);
  return static_cast<int>(found - description.cameras.begin());
}

/// The sun of a clear sky; null = it has none, or it has set for good.
const LightDescription* find_sun(const RenderDescription& description) {
  const auto sun = std::ranges::find(description.lights, true, &LightDescription::of_sky);
  return sun != description.lights.end() ? &*sun : nullptr;
}

/// A point of a camera's picture [px].
struct PicturePoint {
  double u = kNoReading, v = kNoReading;
  bool is_inside = false;
};

/// Directions seen by a camera as points of its picture.
class PictureOf {
 public:
  PictureOf(const Intrinsics& intrinsics, const Affine3f& X_WC)
      : k_(intrinsics), lens_(make_lens<double>(intrinsics)), X_WC_(X_WC) {}

  PicturePoint of(Vec3f direction) const {
    PicturePoint point;
    double x, y;
    // Rays of orthographic cameras are parallel: they see no more than one direction.
    if (k_.orthographic ||
        !lens_project(lens_, double{dot(direction, X_WC_.x)}, -double{dot(direction, X_WC_.y)},
                      -double{dot(direction, X_WC_.z)}, &x, &y))
      return point;
    point.u = k_.cx + k_.fx * x, point.v = k_.cy + k_.fy * y;
    point.is_inside = point.u >= 0 && point.v >= 0 && point.u < k_.width && point.v < k_.height;
    return point;
  }

 private:
  const Intrinsics& k_;
  const LensOf<double> lens_;
  const Affine3f X_WC_;
};

/// Directions evenly over a disc far away: a spiral by the golden angle (Vogel 1979).
std::vector<Vec3f> disc_directions(Vec3f middle, float sine) {
  constexpr int kDirections = 128;
  constexpr float kGolden = 2.39996323f;  // [rad]
  const Frame frame = Frame::from_z(middle);
  std::vector<Vec3f> directions;
  for (int i = 0; i < kDirections; ++i) {
    const float r = sine * std::sqrt((static_cast<float>(i) + 0.5f) / kDirections);
    const float angle = kGolden * static_cast<float>(i);
    directions.push_back(normalize(
        frame.to_world({r * std::cos(angle), r * std::sin(angle), std::sqrt(1 - r * r)})));
  }
  return directions;
}

/// Fills u, v, fraction of the disc in the picture, fraction of its light that the picture shows.
void read_sun_disc(const ProbeRenderer& shared, int camera, const PoseFrame& poses,
                   std::span<double> numbers) {
  numbers[0] = numbers[1] = kNoReading;
  numbers[2] = numbers[3] = 0;
  const RenderDescription& description = *shared.description;
  const LightDescription* sun = find_sun(description);
  if (sun == nullptr) return;
  const PoseFrame* const key = &poses;
  const CameraView view = view_at(description, camera, {&key, 1}, poses);
  const PictureOf picture(view.intrinsics, view.X_WC_open);
  const Vec3f middle =
      description.sky.day ? to_sun_at(*description.sky.day, poses.time) : sun->X_BL.z;
  const PicturePoint at = picture.of(middle);
  numbers[0] = at.u, numbers[1] = at.v;
  std::vector<Vec3f> seen;
  const std::vector<Vec3f> disc = disc_directions(middle, sun->radius);
  std::ranges::copy_if(disc, std::back_inserter(seen),
                       [&](Vec3f d) { return picture.of(d).is_inside; });
  const double count = static_cast<double>(disc.size());
  numbers[2] = static_cast<double>(seen.size()) / count;
  std::erase_if(seen, [](Vec3f d) { return d.z < 0; });  // below the sky's horizon
  if (seen.empty()) return;
  std::vector<float> passed(seen.size());
  const std::lock_guard lock(*shared.turns);
  shared.renderer->update(poses, poses, poses);
  shared.renderer->distant_light(view, seen, passed);
  for (const float one : passed) numbers[3] += double{one} / count;
}

}  // namespace

Result<ProbeReader> illuminance_probe(const ProbeDescription& probe, const ProbeSetup& setup) {
  GLOAM_TRY(const ProbeRenderer shared, setup.renderer());
  return ProbeReader([&probe, shared](ProbeInstant& at, std::span<double> numbers) -> Status {
    GLOAM_TRY(const Vec3 p, at.place(probe));
    GLOAM_TRY(const Vec3 n, at.normal(probe));
    GLOAM_TRY(const PoseFrame* const poses, at.poses());
    const std::lock_guard lock(*shared.turns);
    shared.renderer->update(*poses, *poses, *poses);
    numbers[0] = double{shared.renderer->illuminance(
        to_vec3f(from_origin(p, shared.description->origin)), to_vec3f(n))};
    return {};
  });
}

Result<ProbeReader> exposure_probe(const ProbeDescription& probe, const ProbeSetup& setup) {
  const std::string& camera = probe.options.camera;
  GLOAM_TRY(const ProbeRenderer shared, setup.renderer());
  const RenderDescription& description = *shared.description;
  const CameraSensing& sensing =
      description.cameras[static_cast<size_t>(camera_row(description, camera))].sensing;
  const double rule =
      setup.world->scene.render.ev100.value_or(static_cast<double>(description.ev100));
  const Exposure fixed = fixed_exposure(sensing, rule);
  const bool is_metered = sensing.imager && sensing.imager->auto_exposure;
  const bool is_own = sensing.imager && sensing.imager->exposure;
  return ProbeReader([=, &camera, metered_ev100 = setup.sources.metered_ev100](
                         ProbeInstant& at, std::span<double> numbers) -> Status {
    numbers[0] = is_own ? fixed.ev100() : rule;
    if (!is_metered) return {};
    GLOAM_TRY(const double metered, metered_ev100(camera, at.snapshot()));
    numbers[0] = metered_exposure(sensing, fixed.f_number, metered).ev100();
    return {};
  });
}

Result<ProbeReader> sun_disc_probe(const ProbeDescription& probe, const ProbeSetup& setup) {
  GLOAM_TRY(const ProbeRenderer shared, setup.renderer());
  const int camera = camera_row(*shared.description, probe.options.camera);
  return ProbeReader([shared, camera](ProbeInstant& at, std::span<double> numbers) -> Status {
    GLOAM_TRY(const PoseFrame* const poses, at.poses());
    read_sun_disc(shared, camera, *poses, numbers);
    return {};
  });
}

}  // namespace gloam
