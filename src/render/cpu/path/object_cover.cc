#include "render/cpu/path/object_cover.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "base/parallel.h"
#include "render/kernel/camera/channels.h"

namespace gloam {
namespace {

constexpr int kChunks = 32;       // of rows, which have counts of their own
constexpr int kMostPassed = 256;  // surfaces along one ray

void add_pixel(int x, int y, PixelBox* box) {
  box->u0 = std::min(box->u0, x);
  box->v0 = std::min(box->v0, y);
  box->u1 = std::max(box->u1, x + 1);
  box->v1 = std::max(box->v1, y + 1);
  ++box->pixels;
}

void add_box(const PixelBox& from, PixelBox* to) {
  to->u0 = std::min(to->u0, from.u0);
  to->v0 = std::min(to->v0, from.v0);
  to->u1 = std::max(to->u1, from.u1);
  to->v1 = std::max(to->v1, from.v1);
  to->pixels += from.pixels;
}

}  // namespace

std::map<uint32_t, ObjectCover> measure_cover(const SceneView& scene, const CpuTracer& tracer,
                                              const CameraView32& camera, bool has_motion,
                                              int width, int height,
                                              const std::vector<uint32_t>& object_of) {
  struct Met {
    ObjectCover cover;
    int last = -1;  // pixel in which the object was met
  };
  std::vector<std::unordered_map<uint32_t, Met>> parts(kChunks);
  parallel_for("object cover", kChunks, [&](int64_t chunk) {
    std::unordered_map<uint32_t, Met>& objects = parts[static_cast<size_t>(chunk)];
    for (int y = static_cast<int>(chunk) * height / kChunks;
         y < (static_cast<int>(chunk) + 1) * height / kChunks; ++y) {
      for (int x = 0; x < width; ++x) {
        RayCone cone;
        Ray ray = camera_ray(camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                             has_motion ? camera.time_of(y, 0) : 0.0f, &cone);
        bool first = true;
        for (int passed = 0; sees(ray) && passed < kMostPassed; ++passed) {
          RayHit hit;
          if (!tracer.trace(ray, false, &hit)) break;
          const Surface s = make_surface(scene, ray, hit, cone);
          if (shows(scene, s)) {
            Met& met = objects[object_of[s.instance]];
            if (first) add_pixel(x, y, &met.cover.seen);
            first = false;
            if (std::exchange(met.last, y * width + x) != y * width + x)
              add_pixel(x, y, &met.cover.all);
          }
          ray.o = leave_surface(s.p, s.geometric, ray.d, hit.t);
        }
      }
    }
  });
  std::map<uint32_t, ObjectCover> covers;
  for (const auto& part : parts) {
    for (const auto& [object, met] : part) {
      add_box(met.cover.seen, &covers[object].seen);
      add_box(met.cover.all, &covers[object].all);
    }
  }
  return covers;
}

}  // namespace gloam
