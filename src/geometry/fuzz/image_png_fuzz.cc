#include "geometry/image/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)gloam::decode_png({data, size}, "fuzz.png", 1 << 20).ok();
  (void)gloam::decode_png16({data, size}, "fuzz.png", 1 << 20).ok();
  return 0;
}
