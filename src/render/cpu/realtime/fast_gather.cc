
#include "render/cpu/realtime/fast_gather.h"

namespace gloam::fasts {

template LampLightOf<FloatLanes> direct_light(const FastWorld<CpuTracer>&,
                                              const LitSurfaceOf<FloatLanes>&,
                                              const LampOptionsOf<FloatLanes>&,
                                              paths::State<FloatLanes>*);
template MediaLightOf<FloatLanes> cross_media(const FastWorld<CpuTracer>&,
                                              const MediaOptionsOf<FloatLanes>&,
                                              paths::State<FloatLanes>*, CacheRequest*);
template GatheredOf<FloatLanes> gather(const FastWorld<CpuTracer>&,
                                       const GatherOptionsOf<FloatLanes>&, MaskLanes,
                                       paths::State<FloatLanes>*, CacheRequest*);

}  // namespace gloam::fasts
