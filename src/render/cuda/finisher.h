#pragma once
// The way of a picture from its samples on the card to what the host asks for: without noise, as
// light or as display values.

#include <map>
#include <memory>
#include <utility>

#include "render/cuda/device_denoiser.h"
#include "render/cuda/device_memory.h"
#include "render/cuda/kernels.h"
#include "render/renderer.h"

namespace gloam::cuda {

class Finisher {
 public:
  /// The stream must outlive it.
  explicit Finisher(Stream stream) : stream_(stream) {}

  /// Whether the card carries this out. The first call that asks for a denoiser loads it.
  bool can(const PictureFinish& finish);
  /// Queues the denoiser; film->radiance then is light without noise. Only after can() has returned
  /// true.
  void denoise(int width, int height, DeviceFilm* film);
  /// Queues the tone map of film->radiance into film->rgb.
  void show(const ToneMapSettings& tone, int width, int height, DeviceFilm* film);

 private:
  /// The denoiser's work on pictures of one size.
  struct Work {
    DeviceBuffer buffer;
    FinishPicture picture;
    std::unique_ptr<DeviceFilter> filter;
  };
  Work& work_of(int width, int height);

  Stream stream_;
  bool has_tried_ = false;
  std::unique_ptr<DeviceDenoiser> denoiser_;
  std::map<std::pair<int, int>, Work> works_;  ///< by width and height
  DeviceBuffer rgb_;
};

}  // namespace gloam::cuda
