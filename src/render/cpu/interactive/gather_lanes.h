#pragma once
// Functions of the interactive stage that its files share: gather_lanes.cc compiles them.

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/kernel/interactive/gather.h"

namespace gloam::interactive {

extern template LampLightOf<FloatLanes> direct_light(const InteractiveWorld<CpuTracer>&,
                                                     const LitSurfaceOf<FloatLanes>&,
                                                     const LampOptionsOf<FloatLanes>&,
                                                     paths::State<FloatLanes>*);
extern template MediaLightOf<FloatLanes> cross_media(const InteractiveWorld<CpuTracer>&,
                                                     const MediaOptionsOf<FloatLanes>&,
                                                     paths::State<FloatLanes>*, CacheRequest*);
extern template GatheredOf<FloatLanes> gather(const InteractiveWorld<CpuTracer>&,
                                              const GatherOptionsOf<FloatLanes>&, MaskLanes,
                                              paths::State<FloatLanes>*, CacheRequest*);

}  // namespace gloam::interactive
