#pragma once
// Drops and flakes in front of a camera, drawn over a finished picture: each is a disc that moves
// while the shutter is open, so no sampling noise is left of them and no filter takes them for
// noise. Far away they are a medium (world/weather/weather_description.h); what is drawn here is
// how the near ones differ from its mean.

#include <vector>

#include "render/cpu/tracer/cpu_tracer.h"
#include "render/film/film.h"
#include "render/kernel/camera/camera.h"
#include "world/weather/weather_description.h"

namespace gloam {

struct ParticleView {
  const SceneView& scene;
  const CpuTracer& tracer;
  const CameraView32& camera;
  const WeatherDescription& weather;
  double opens = 0;    ///< when the first row's exposure starts [s]
  double seconds = 0;  ///< that CameraView32::shutter's unit lasts [s]; 0 = an instant
};

/// `film`: its exact channel `distance`; `radiance`: the picture [cd/m²].
void draw_particles(const ParticleView& view, const Film& film, std::vector<Vec3f>* radiance);

}  // namespace gloam
