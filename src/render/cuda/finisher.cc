#include "render/cuda/finisher.h"

#include "base/log.h"
#include "render/film/tone_map.h"

namespace gloam::cuda {
namespace {

/// Sizes of pictures that are kept ready.
constexpr size_t kMostSizes = 8;

/// Calls put(plane, count) for all planes that the picture owns.
template <class Put>
void each_plane(FinishPicture* p, const Put& put) {
  const size_t n = static_cast<size_t>(p->width) * static_cast<size_t>(p->height);
  const auto wide = static_cast<size_t>(p->wide_width()) * static_cast<size_t>(p->wide_height());
  for (Vec3f** plane : {&p->color, &p->spread, &p->light, &p->rows[0], &p->rows[1], &p->windows[0],
                        &p->windows[1], &p->finished}) {
    put(plane, n);
  }
  for (Vec3f** plane : {&p->wide_color, &p->wide_albedo, &p->wide_normal, &p->clean})
    put(plane, wide);
  put(&p->brightness, n);
  put(&p->flies, static_cast<size_t>(p->words()) * static_cast<size_t>(p->height));
  put(&p->totals, size_t{6} * FinishPicture::kTotalBlocks);
  put(&p->gain, size_t{1});
}

}  // namespace

bool Finisher::can(const PictureFinish& finish) {
  if (!finish.denoise || has_tried_) return !finish.denoise || denoiser_ != nullptr;
  has_tried_ = true;
  auto denoiser = DeviceDenoiser::make(stream_);
  if (!denoiser.ok()) {
    log_debug("{}; images are denoised on the host", denoiser.error().to_string());
    return false;
  }
  denoiser_ = std::move(denoiser).value();
  log_debug("denoiser: Open Image Denoise on the GPU's own planes");
  return true;
}

Finisher::Work& Finisher::work_of(int width, int height) {
  const auto found = works_.find({width, height});
  if (found != works_.end()) return found->second;
  if (works_.size() >= kMostSizes) {
    check(cudaStreamSynchronize(stream_), "a CUDA kernel failed");
    works_.clear();
  }
  Work& work = works_[{width, height}];
  FinishPicture& picture = work.picture;
  picture.width = width;
  picture.height = height;
  picture.border = oidn::kBorder;
  DeviceLayout measured;
  each_plane(&picture, [&](auto** plane, size_t count) { measured.put(plane, count); });
  DeviceLayout layout(work.buffer.reserve(measured.bytes()));
  each_plane(&picture, [&](auto** plane, size_t count) { layout.put(plane, count); });
  work.filter = std::make_unique<DeviceFilter>(*denoiser_, picture);
  return work;
}

void Finisher::denoise(int width, int height, DeviceFilm* film) {
  Work& work = work_of(width, height);
  FinishPicture picture = work.picture;
  picture.radiance = film->radiance;
  picture.albedo = film->albedo;
  picture.normal = film->normal;
  launch_prepare(picture, stream_);
  work.filter->run();
  launch_restore(picture, stream_);
  check(cudaGetLastError(), "cannot launch a CUDA kernel");
  film->radiance = picture.finished;
}

void Finisher::show(const ToneMapSettings& tone, int width, int height, DeviceFilm* film) {
  film->rgb =
      rgb_.reserve_of<uint8_t>(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  launch_tone_map(film->radiance, width, height, max_luminance(tone.ev100), tone, film->rgb,
                  stream_);
  check(cudaGetLastError(), "cannot launch a CUDA kernel");
}

}  // namespace gloam::cuda
