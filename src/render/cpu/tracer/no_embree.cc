// A build without Embree: our own BVH traces everything.

#include "render/cpu/tracer/embree_scene.h"
#include "render/renderer.h"

namespace gloam {

Result<std::unique_ptr<EmbreeScene>> EmbreeScene::make() { return std::unique_ptr<EmbreeScene>(); }

std::string ray_tracer_version() { return "Gloam's own BVH"; }

bool CpuTracer::by_embree(const Ray&, bool, RayHit*) const { return false; }
MaskLanes CpuTracer::closest_by_embree(const RayOf<FloatLanes>&, MaskLanes, bool,
                                       RayHitOf<FloatLanes>*) const {
  return false;
}
MaskLanes CpuTracer::occluded_by_embree(const RayOf<FloatLanes>&, MaskLanes) const { return false; }

}  // namespace gloam
