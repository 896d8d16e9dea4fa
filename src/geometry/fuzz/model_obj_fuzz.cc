#include "geometry/mesh/model_source.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  gloam::ModelFileOptions options;
  options.limits.decoded_bytes = 64 << 20;
  (void)gloam::read_obj({"fuzz.obj", {data, size}, nullptr, &options}).ok();
  return 0;
}
