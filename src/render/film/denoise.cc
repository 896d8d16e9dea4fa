#include "render/film/denoise.h"

#include "base/log.h"

namespace gloam {

std::unique_ptr<Denoiser> make_denoiser(const DenoiseOptions& options) {
  if (options.use_oidn) {
    Result<std::unique_ptr<Denoiser>> oidn = make_oidn_denoiser(options.quality);
    if (oidn.ok()) return std::move(oidn).value();
    log_debug("{}; using Gloam's own filter", oidn.error().to_string());
  }
  return make_edge_denoiser();
}

}  // namespace gloam
