#pragma once
// The air between a camera and what it sees, for models that come after the light: the volumes of
// the scene, with the grids that effects have solved for, and steps through them.

#include <algorithm>
#include <limits>

#include "render/scene/volume_store.h"
#include "world/render_description.h"

namespace gloam {

class SensorAir {
 public:
  SensorAir() = default;
  /// Errors: a damaged volume.
  static Result<SensorAir> make(const RenderDescription& description);

  /// The grids of the frame's instant.
  void follow(const RenderDescription& description, const PoseFrame& now) {
    volumes_.follow(description.volumes, now);
  }
  /// Valid until follow().
  MediaView view() const { return volumes_.view(); }

 private:
  VolumeStore volumes_;
};

/// Interval of the ray inside the volume's box, [near, far] along it in units of `direction_G`;
/// false = nowhere.
bool crosses(const VolumeView& volume, Vec3f origin_G, Vec3f direction_G, double* near,
             double* far);

/// visit(p_W, from, to): steps along the ray from the camera on up to `distance` [m], where there
/// are volumes: all of them together in even ones.
template <class Visit>
void each_step(const MediaView& media, Vec3f origin, Vec3f direction, double distance,
               const Visit& visit) {
  constexpr int kSteps = 64;
  double from = std::numeric_limits<double>::infinity(), to = 0;
  for (uint32_t i = 0; i < media.volumes.size; ++i) {
    const VolumeView& v = media.volumes[i];
    double near = 0, far = 0;
    if (!crosses(v, transform_point(v.X_GW, origin), transform_vector(v.X_GW, direction), &near,
                 &far))
      continue;
    from = std::min(from, near);
    to = std::max(to, std::min(far, distance));
  }
  if (!(from < to)) return;
  const double step = (to - from) / kSteps;
  for (int j = 0; j < kSteps; ++j) {
    visit(origin + direction * static_cast<float>(from + (j + 0.5) * step), from + j * step,
          from + (j + 1) * step);
  }
}

}  // namespace gloam
