#include "geometry/image/image_exr.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)gloam::decode_exr({data, size}, "fuzz.exr", 1 << 20).ok();
  return 0;
}
