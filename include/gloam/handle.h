#pragma once
// Typed indices of a World's elements.

#include <cstdint>

namespace gloam {

/// Typed index of a named element. Resolve once with World::find_*, then use on every Snapshot of
/// that World. After a recompile find it again: a handle of another World is refused.
template <class Kind>
struct Handle {
  int id = -1;
  uint64_t world = 0;  ///< World that found it; 0 = an id made by the user, taken unchecked
};
using Joint = Handle<struct JointKind>;
using Body = Handle<struct BodyKind>;
using Actuator = Handle<struct ActuatorKind>;
using SensorHandle = Handle<struct SensorHandleKind>;
using Camera = Handle<struct CameraKind>;
using Geom = Handle<struct GeomKind>;
using Tendon = Handle<struct TendonKind>;
using Robot = Handle<struct RobotKind>;  ///< id: by order of World::robots()

}  // namespace gloam
