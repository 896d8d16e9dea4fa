#pragma once
// The sections of a scene that a robot.toml may hold templates of.

#include <array>
#include <string_view>

#include "gloam/scene.h"

namespace gloam {

/// A kind of template: the section that it becomes and the keys of that section.
struct MountedKind {
  std::string_view section;  ///< "lidar"
  std::string_view parent;   ///< key that `mount` becomes
  bool has_name = true;      ///< the section has a `name`
};

inline constexpr std::array kMountedKinds = {
    MountedKind{"camera", "body"}, MountedKind{"lidar", "body"},
    MountedKind{"stereo", "body"}, MountedKind{"rgbd", "body"},
    MountedKind{"probe", "body"},  MountedKind{"sensor", "match", false}};

/// Calls `f(list of to, list of from)` for the sections of kMountedKinds.
template <class F>
void visit_mounted(Scene& to, Scene& from, F&& f) {
  f(to.cameras, from.cameras);
  f(to.lidars, from.lidars);
  f(to.stereo, from.stereo);
  f(to.rgbd, from.rgbd);
  f(to.probes, from.probes);
  f(to.sensors, from.sensors);
}

}  // namespace gloam
