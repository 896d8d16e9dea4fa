#include "render/cpu/particles/particle_light.h"

#include <algorithm>

#include "base/parallel.h"
#include "render/kernel/light/ambient_path.h"

namespace gloam {

AmbientCube light_around(const SceneView& scene, const CpuTracer& tracer, Vec3f p_W) {
  constexpr int kLog2Paths = 9;
  constexpr int64_t kPaths = int64_t{1} << kLog2Paths;
  std::vector<Vec3f> light(kPaths), toward(kPaths);
  parallel_for_range("light around particles", kPaths, 32, [&](int64_t begin, int64_t end) {
    for (int64_t i = begin; i < end; ++i) {
      Sampler sampler = Sampler::make(0, 0, 0, 0, static_cast<uint32_t>(i), kLog2Paths);
      Ray ray;
      ray.o = p_W;
      ray.d = sample_sphere(sampler.next_2d());
      constexpr int kDepth = 3;
      light[static_cast<size_t>(i)] = ambient::incoming(scene, tracer, ray, kDepth, sampler);
      toward[static_cast<size_t>(i)] = ray.d;
    }
  });
  AmbientCube cube;
  for (int facing = 0; facing < LightGuide::kFacings; ++facing) {
    const float side = facing % 2 == 0 ? 1.0f : -1.0f;
    Vec3f sum;
    float weight = 0;
    for (size_t i = 0; i < light.size(); ++i) {
      const float cosine = side * toward[i][facing / 2];
      if (cosine <= 0) continue;
      sum += light[i] * cosine;
      weight += cosine;
    }
    cube.light[facing] = sum * (1 / weight);
  }
  return cube;
}

BlurredPicture::BlurredPicture(const std::vector<Vec3f>& picture, int width, int height,
                               float focal)
    : cell_(std::max(4, width / 32)),
      nx_((width + cell_ - 1) / cell_),
      ny_((height + cell_ - 1) / cell_),
      light_(static_cast<size_t>(nx_ * ny_)) {
  std::vector<Vec3f> mean(light_.size());
  for (int j = 0; j < ny_; ++j) {
    for (int i = 0; i < nx_; ++i) {
      Vec3f sum;
      int count = 0;
      for (int y = j * cell_; y < std::min((j + 1) * cell_, height); ++y) {
        for (int x = i * cell_; x < std::min((i + 1) * cell_, width); ++x, ++count)
          sum +=
              picture[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
      }
      mean[static_cast<size_t>(j * nx_ + i)] = sum * (1 / static_cast<float>(count));
    }
  }
  constexpr float kAngle = 0.35f;  // [rad]
  const int reach = std::max(1, static_cast<int>(kAngle * focal / static_cast<float>(cell_)));
  for (int j = 0; j < ny_; ++j) {
    for (int i = 0; i < nx_; ++i) {
      Vec3f sum;
      float weight = 0;
      for (int y = std::max(j - reach, 0); y <= std::min(j + reach, ny_ - 1); ++y) {
        for (int x = std::max(i - reach, 0); x <= std::min(i + reach, nx_ - 1); ++x) {
          const auto far2 = static_cast<float>((x - i) * (x - i) + (y - j) * (y - j));
          const float w = std::max(0.0f, 1 - far2 / static_cast<float>((reach + 1) * (reach + 1)));
          sum += mean[static_cast<size_t>(y * nx_ + x)] * w;
          weight += w;
        }
      }
      light_[static_cast<size_t>(j * nx_ + i)] = sum * (1 / weight);
    }
  }
}

}  // namespace gloam
