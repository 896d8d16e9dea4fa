#pragma once
// A scene with its tracer, for tests that call the kernel themselves.

#include "render/cpu/guide/light_guide.h"
#include "render/cpu/tracer/traced_scene.h"
#include "render/kernel/camera/channels.h"
#include "render/kernel/path/direct.h"
#include "render/test/scene_builder.h"

namespace gloam {

/// Tracer of a renderer of the scene; `keeps_own`: our own BVH beside Embree.
inline TracedScene trace_scene(const SceneBuilder& builder, bool keeps_own = false) {
  auto scene = RenderScene::make(builder.description);
  GLOAM_CHECK(scene.ok(), "the test's scene is refused");
  auto embree = EmbreeScene::make();
  GLOAM_CHECK(embree.ok(), "Embree does not start");
  return {std::move(*scene), std::move(*embree), keeps_own};
}

class Probe {
 public:
  explicit Probe(const SceneBuilder& builder) : builder_(builder), traced_(trace_scene(builder_)) {
    const PoseFrame* const key = &builder_.frame;
    traced_.update({&key, 1}, builder_.frame);
    view = traced_.scene().view_from({});
    tracer = traced_.tracer();
  }

  /// Gives the view its light guide.
  void guide() {
    guide_.build(view, traced_.static_tracer(), traced_.scene().described_look(builder_.frame));
    view.guide = guide_.view();
  }

  SceneView view;
  CpuTracer tracer;

 private:
  SceneBuilder builder_;
  TracedScene traced_;
  LightGuideStore guide_;
};

inline Sampler draw(uint32_t i, uint64_t seed = 1) { return Sampler::make(seed, 0, 0, 0, i, 24); }

inline Ray make_ray(Vec3f o, Vec3f d) {
  Ray ray;
  ray.o = o;
  ray.d = normalize(d);
  return ray;
}

/// Running mean and standard error.
struct Mean {
  double mean = 0, squares = 0;
  int64_t n = 0;
  void add(double x) {
    ++n;
    const double delta = x - mean;
    mean += delta / static_cast<double>(n);
    squares += delta * (x - mean);
  }
  double standard_error() const {
    return std::sqrt(squares / (static_cast<double>(n) * static_cast<double>(n - 1)));
  }
};

/// Mean over the picture of the red channel, and its standard error from the pixels' variances.
inline Mean picture_mean(const Film& film) {
  Mean m;
  double sum = 0, variance = 0;
  for (size_t i = 0; i < film.radiance.size(); ++i) {
    sum += film.radiance[i].x;
    variance += film.variance[i].x;
  }
  const double n = static_cast<double>(film.radiance.size());
  m.mean = sum / n;
  m.n = static_cast<int64_t>(n);
  m.squares = variance / (n * n) * n * (n - 1);  // so that standard_error() is that of the mean
  return m;
}

}  // namespace gloam
