#pragma once
// Embree behind one face: acceleration structures of a RenderScene and the Tracer that the kernel
// is compiled with. Static geometry is one BVH, built once; each moving geom is an instance of the
// BVH of its shape with one or more motion keys. Infinite planes and the largest simple solids that
// stand still stay outside, in a short list.

#include <memory>

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/scene/render_scene.h"

namespace gloam {

class EmbreeScene {
 public:
  /// Null in a build without Embree. Errors: Embree cannot start, out of
  /// memory.
  static Result<std::unique_ptr<EmbreeScene>> make();
  virtual ~EmbreeScene() = default;

  /// Builds what is missing, moves what moves. `scene` must be updated before
  /// and stay the same object.
  virtual Status update(const RenderScene& scene) = 0;
  virtual CpuTracer tracer(const RenderScene& scene) const = 0;
  /// Tracer of the bodies that never move, without infinite planes; without a scene it hits
  /// nothing.
  virtual CpuTracer static_tracer(const RenderScene& scene) const = 0;
};

}  // namespace gloam
