#pragma once
// A scene with its tracer, for tests that call the kernel themselves.

#include "render/cpu/embree_scene.h"
#include "render/cpu/light_guide.h"
#include "render/kernel/channels.h"
#include "render/kernel/direct.h"
#include "render/test/scene_builder.h"

namespace gloam {

class Probe {
 public:
  explicit Probe(const SceneBuilder& builder) : builder_(builder) {
    auto scene = RenderScene::make(builder_.description);
    GLOAM_CHECK(scene.ok(), "the test's scene is refused");
    scene_ = std::move(*scene);
    const PoseFrame* const key = &builder_.frame;
    scene_->update({&key, 1}, builder_.frame);
    embree_ = std::move(*EmbreeScene::make());
    GLOAM_CHECK(embree_->update(*scene_).ok(), "the test's BVH fails");
    view = scene_->view_from({});
    tracer = embree_->tracer(*scene_);
  }

  /// Gives the view its light guide.
  void guide() {
    guide_.build(view, embree_->static_tracer(*scene_), scene_->described_look(builder_.frame));
    view.guide = guide_.view();
  }

  SceneView view;
  CpuTracer tracer;

 private:
  SceneBuilder builder_;
  std::unique_ptr<RenderScene> scene_;
  std::unique_ptr<EmbreeScene> embree_;
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
