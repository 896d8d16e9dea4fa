#pragma once
// Typed indices of a World's elements.

#include <cstdint>

namespace gloam {

/// Typed index of a named element. Resolve it once with World::find_*, then use it on every
/// Snapshot of that World. Look it up again after a recompile: handles of another World are
/// rejected.
template <class Kind>
struct Handle {
  int id = -1;
  uint64_t world = 0;  ///< World that found it; 0 = an unchecked id from the user
};
using Joint = Handle<struct JointKind>;
using Body = Handle<struct BodyKind>;
using Actuator = Handle<struct ActuatorKind>;
using SensorHandle = Handle<struct SensorHandleKind>;
using Camera = Handle<struct CameraKind>;
using Geom = Handle<struct GeomKind>;
using Tendon = Handle<struct TendonKind>;
using Equality = Handle<struct EqualityKind>;
using Robot = Handle<struct RobotKind>;  ///< id: index in World::robots()

}  // namespace gloam
