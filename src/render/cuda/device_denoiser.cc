#include "render/cuda/device_denoiser.h"

#include "base/check.h"
#include "render/film/denoise.h"

namespace gloam::cuda {

Result<std::unique_ptr<DeviceDenoiser>> DeviceDenoiser::make(Stream stream) {
  GLOAM_TRY(const oidn::Api api, oidn::load_api());
  const int id = 0;
  GLOAM_TRY(const oidn::Device device,
            oidn::commit(api, api.new_cuda_device(&id, &stream, 1), "GPU"));
  return std::unique_ptr<DeviceDenoiser>(new DeviceDenoiser(api, device));
}

DeviceFilter::DeviceFilter(const DeviceDenoiser& denoiser, const FinishPicture& picture)
    : api_(denoiser.api_), device_(denoiser.device_), filter_(api_.new_filter(device_, "RT")) {
  api_.set_int(filter_, "quality", oidn::kQuality[static_cast<int>(DenoiseOptions().quality)]);
  api_.set_bool(filter_, "hdr", true);
  const auto width = static_cast<size_t>(picture.wide_width());
  const auto height = static_cast<size_t>(picture.wide_height());
  const auto bind = [&](const char* name, Vec3f* plane) {
    api_.set_image(filter_, name, plane, oidn::kFormatFloat3, width, height, 0, 0, 0);
  };
  bind("color", picture.wide_color);
  bind("albedo", picture.wide_albedo);
  bind("normal", picture.wide_normal);
  bind("output", picture.clean);
  api_.commit_filter(filter_);
}

void DeviceFilter::run() {
  api_.execute_filter_async(filter_);
  const char* message = nullptr;
  // The card has agreed to denoise before: it can only be full, or broken.
  if (api_.get_device_error(device_, &message) != oidn::kErrorNone)
    check_failed("Open Image Denoise", 0, message, "denoising on the GPU failed");
}

}  // namespace gloam::cuda
