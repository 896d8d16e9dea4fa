// Gathering of light for several pixels at once: instances of the templates for SIMD lanes.
#include "render/cpu/interactive/gather_lanes.h"

namespace gloam::interactive {

template LampLightOf<FloatLanes> direct_light(const InteractiveWorld<CpuTracer>&,
                                              const LitSurfaceOf<FloatLanes>&,
                                              const LampOptionsOf<FloatLanes>&,
                                              paths::State<FloatLanes>*);
template MediaLightOf<FloatLanes> cross_media(const InteractiveWorld<CpuTracer>&,
                                              const MediaOptionsOf<FloatLanes>&,
                                              paths::State<FloatLanes>*, CacheRequest*);
template GatheredOf<FloatLanes> gather(const InteractiveWorld<CpuTracer>&,
                                       const GatherOptionsOf<FloatLanes>&, MaskLanes,
                                       paths::State<FloatLanes>*, CacheRequest*);

}  // namespace gloam::interactive
