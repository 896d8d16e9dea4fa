#pragma once
// Open Image Denoise between kernels: on the card's own planes, in the renderer's stream.

#include <memory>

#include "render/cuda/finish_kernels.h"
#include "render/film/oidn_api.h"

namespace gloam::cuda {

class DeviceDenoiser {
 public:
  /// Error: Open Image Denoise is missing, or refuses this card. The stream must outlive it.
  static Result<std::unique_ptr<DeviceDenoiser>> make(Stream stream);
  ~DeviceDenoiser() { api_.release_device(device_); }
  DeviceDenoiser(const DeviceDenoiser&) = delete;
  DeviceDenoiser& operator=(const DeviceDenoiser&) = delete;

 private:
  friend class DeviceFilter;
  DeviceDenoiser(const oidn::Api& api, oidn::Device device) : api_(api), device_(device) {}

  oidn::Api api_;
  oidn::Device device_;
};

/// The network for pictures of one size, in planes that stay where they are. The denoiser must
/// outlive it.
class DeviceFilter {
 public:
  DeviceFilter(const DeviceDenoiser& denoiser, const FinishPicture& picture);
  ~DeviceFilter() { api_.release_filter(filter_); }
  DeviceFilter(const DeviceFilter&) = delete;
  DeviceFilter& operator=(const DeviceFilter&) = delete;

  /// Queues the network from wide_color, wide_albedo and wide_normal into `clean`.
  void run();

 private:
  oidn::Api api_;
  oidn::Device device_;
  oidn::Filter filter_;
};

}  // namespace gloam::cuda
