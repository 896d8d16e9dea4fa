// Samples of lights, compiled once for all stages of the CPU.

#include "render/kernel/light/light_sampler.h"

namespace gloam {

template LightSample sample_one_light<float>(const SceneView&, uint32_t, Vec3f, Vec2f, float, bool);
template LightSampleOf<FloatLanes> sample_one_light<FloatLanes>(const SceneView&, uint32_t,
                                                                Vec3Of<FloatLanes>,
                                                                Vec2Of<FloatLanes>, FloatLanes,
                                                                MaskLanes);
template LightSample LightSampler::sample(const SceneView&, Vec3f, Vec2f, float, bool) const;
template LightSampleOf<FloatLanes> LightSamplerOf<FloatLanes>::sample(const SceneView&,
                                                                      Vec3Of<FloatLanes>,
                                                                      Vec2Of<FloatLanes>,
                                                                      FloatLanes, MaskLanes) const;

}  // namespace gloam
