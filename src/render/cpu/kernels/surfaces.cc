// Surfaces at hits, compiled once for all stages of the CPU.

#include "render/kernel/surface/surface.h"

namespace gloam {

template Surface make_surface<float>(const SceneView&, const Ray&, const RayHit&, RayCone, bool);
template SurfaceOf<FloatLanes> make_surface<FloatLanes>(const SceneView&, const RayOf<FloatLanes>&,
                                                        const RayHitOf<FloatLanes>&,
                                                        RayConeOf<FloatLanes>, MaskLanes);

}  // namespace gloam
