#pragma once
// Functions of the fast stage that its files share: fast_gather.cc compiles them.

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/realtime/fast_gather.h"

namespace gloam::fasts {

extern template LampLightOf<FloatLanes> direct_light(const FastWorld<CpuTracer>&,
                                                     const LitSurfaceOf<FloatLanes>&,
                                                     const LampOptionsOf<FloatLanes>&,
                                                     paths::State<FloatLanes>*);
extern template MediaLightOf<FloatLanes> cross_media(const FastWorld<CpuTracer>&,
                                                     const MediaOptionsOf<FloatLanes>&,
                                                     paths::State<FloatLanes>*, CacheRequest*);
extern template GatheredOf<FloatLanes> gather(const FastWorld<CpuTracer>&,
                                              const GatherOptionsOf<FloatLanes>&, MaskLanes,
                                              paths::State<FloatLanes>*, CacheRequest*);

}  // namespace gloam::fasts
