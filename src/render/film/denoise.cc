#include "render/film/denoise.h"

#include "base/log.h"

namespace gloam {

std::unique_ptr<Denoiser> make_denoiser(const DenoiseOptions& options) {
  if (!options.use_oidn) return make_edge_denoiser();
  Result<std::unique_ptr<Denoiser>> oidn = make_oidn_denoiser(options);
  if (!oidn.ok() && options.device == DenoiseDevice::kCuda) {
    log_debug("{}; denoising on the CPU", oidn.error().to_string());
    oidn = make_oidn_denoiser({.quality = options.quality});
  }
  if (oidn.ok()) {
    log_debug("denoiser: {}", (*oidn)->name());
    return std::move(oidn).value();
  }
  log_debug("{}; using Gloam's own filter", oidn.error().to_string());
  return make_edge_denoiser();
}

}  // namespace gloam
