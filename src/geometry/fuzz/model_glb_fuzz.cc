#include "base/test/custom_mutator.h"
#include "geometry/mesh/model_source.h"
#include "geometry/test/glb_mutator.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  gloam::ModelFileOptions options;
  options.limits.decoded_bytes = 64 << 20;
  (void)gloam::read_glb({"fuzz.glb", {data, size}, nullptr, &options}).ok();
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  return gloam::mutate_structure(data, size, max_size, seed, gloam::mutate_glb);
}
