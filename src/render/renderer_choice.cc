// Which device renders.

#include "base/log.h"
#include "render/cuda/cuda_stages.h"
#include "render/renderer.h"

namespace gloam {

Result<std::unique_ptr<Renderer>> make_renderer(const RenderDescription& description,
                                                RenderDevice device) {
  if (!renders_on_card(device)) return make_cpu_renderer(description);
  if (const auto card = cuda_device_name(); card.ok()) log_info("rendering on {}", *card);
  return make_cuda_renderer(description);
}

bool renders_on_card(RenderDevice device) {
  return device == RenderDevice::kCuda ||
         (device == RenderDevice::kAuto && cuda_device_name().ok());
}

Result<std::string> cuda_device_name() {
  GLOAM_TRY(const auto cuda, CudaStages::make());
  return cuda->device_name();
}

}  // namespace gloam
