#include "sensors/imager/imager.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/image/image_file.h"
#include "gloam/view.h"
#include "render/film/tone_map.h"
#include "sensors/imager/vignetting.h"

namespace gloam {
namespace {

size_t pixel_count(const Intrinsics& k) {
  return static_cast<size_t>(k.width) * static_cast<size_t>(k.height);
}

// A reading without bits as the number of a converter of 16.
uint16_t to_number(double reading, bool quantised) {
  return static_cast<uint16_t>(quantised ? reading
                                         : std::clamp(std::round(reading * 65535), 0.0, 65535.0));
}

}  // namespace

Imager::Imager(const ImagerOptions& options, const Intrinsics& intrinsics, uint64_t seed)
    : options_(options), intrinsics_(intrinsics), mono_(options.mosaic == "mono") {
  if (!mono_ && options.mosaic != "none") mosaic_.emplace(options.mosaic);
  const size_t sites = pixel_count(intrinsics) * sites_per_pixel();
  if (options.pixel) pixels_.emplace(*options.pixel, sites, seed ^ options.seed);
  if (options.vignetting) vignetting_ = vignetting(*options.vignetting, intrinsics);
  shares_.resize(sites);
}

uint64_t Imager::memory(const ImagerOptions& options, const Intrinsics& intrinsics) {
  const uint64_t sites = options.mosaic == "none" ? 3 : 1;
  uint64_t per_pixel = sizeof(float) * sites + sizeof(Vec3f);
  if (options.vignetting) per_pixel += sizeof(float);
  if (options.pixel)
    per_pixel += sizeof(float) * sites *
                 ((options.pixel->prnu > 0 ? 1u : 0u) + (options.pixel->dsnu > 0 ? 1u : 0u));
  return per_pixel * pixel_count(intrinsics);
}

void Imager::develop(const std::vector<Vec3f>& radiance, const Exposure& exposure, int64_t frame,
                     std::vector<uint8_t>* rgb, std::vector<uint16_t>* raw) {
  expose(radiance, exposure, frame, raw);
  if (rgb == nullptr) return;
  const auto ev100 = static_cast<float>(exposure.ev100());
  const double full = pixels_ ? pixels_->full_share(pixels_->gains(exposure)) : INFINITY;
  join_colors(max_luminance(ev100), static_cast<float>(full));
  tone_map(light_, intrinsics_.width, intrinsics_.height,
           {.ev100 = ev100, .neutral = options_.curve == "neutral"}, rgb);
  if (options_.jpeg <= 0) return;
  const auto packed = encode_jpeg(intrinsics_.width, intrinsics_.height, *rgb, options_.jpeg);
  if (!packed.ok()) return;  // a side that JPEG cannot hold: sizes are checked before
  auto unpacked = decode_jpeg(*packed, "the camera's own image");
  if (unpacked.ok()) *rgb = std::move(unpacked->texels);
}

void Imager::expose(const std::vector<Vec3f>& radiance, const Exposure& exposure, int64_t frame,
                    std::vector<uint16_t>* raw) {
  const double top = static_cast<double>(max_luminance(static_cast<float>(exposure.ev100())));
  const PixelArray::Gains gains = pixels_ ? pixels_->gains(exposure) : PixelArray::Gains{};
  const Vec3f balance{static_cast<float>(options_.white_balance.x),
                      static_cast<float>(options_.white_balance.y),
                      static_cast<float>(options_.white_balance.z)};
  const bool quantised = pixels_ && pixels_->quantised();
  if (raw != nullptr) raw->resize(shares_.size());
  const auto width = static_cast<size_t>(intrinsics_.width);
  const auto take = [&](size_t site, float light) {
    double reading, share;
    if (pixels_) {
      reading =
          pixels_->read(gains, static_cast<double>(light), static_cast<uint64_t>(frame), site);
      share = pixels_->share(reading);
    } else {
      reading = share = static_cast<double>(light) / top;
    }
    shares_[site] = static_cast<float>(share);
    if (raw != nullptr) (*raw)[site] = to_number(reading, quantised);
  };
  parallel_for_range("imager", intrinsics_.height, 8, [&](int64_t begin, int64_t end) {
    for (int y = static_cast<int>(begin); y < end; ++y) {
      for (int x = 0; x < intrinsics_.width; ++x) {
        const size_t i = static_cast<size_t>(y) * width + static_cast<size_t>(x);
        Vec3f light = radiance[i];
        if (!vignetting_.empty()) light = light * vignetting_[i];
        if (mono_) {
          take(i, luminance(light));
        } else if (mosaic_) {
          const int c = mosaic_->color(x, y);
          take(i, light[c] / balance[c]);
        } else {
          for (int c = 0; c < 3; ++c) take(3 * i + static_cast<size_t>(c), light[c] / balance[c]);
        }
      }
    }
  });
}

void Imager::join_colors(float top_light, float full) {
  const size_t n = pixel_count(intrinsics_);
  if (mosaic_) {
    demosaic(*mosaic_, shares_, intrinsics_.width, intrinsics_.height, &light_);
  } else {
    light_.resize(n);
    for (size_t i = 0; i < n; ++i) {
      light_[i] = mono_ ? Vec3f{shares_[i], shares_[i], shares_[i]}
                        : Vec3f{shares_[3 * i], shares_[3 * i + 1], shares_[3 * i + 2]};
    }
  }
  if (mono_) {
    for (Vec3f& light : light_) light = light * top_light;
    return;
  }
  // Amplified red and blue would outshine a green that is full: all are cut there.
  const Vec3f balance{static_cast<float>(options_.white_balance.x),
                      static_cast<float>(options_.white_balance.y),
                      static_cast<float>(options_.white_balance.z)};
  for (Vec3f& light : light_) {
    light = light * balance;
    light = Vec3f{min(light.x, full), min(light.y, full), min(light.z, full)} * top_light;
  }
}

}  // namespace gloam
