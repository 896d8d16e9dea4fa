#include "geometry/mesh/model_source.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  gloam::ModelFileOptions options;
  options.limits.decoded_bytes = 64 << 20;
  options.limits.instances = 1 << 12;
  (void)gloam::read_collada({"fuzz.dae", {data, size}, nullptr, &options}).ok();
  return 0;
}
