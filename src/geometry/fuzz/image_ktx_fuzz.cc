#include "geometry/image/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)gloam::decode_ktx({data, size}, "fuzz.ktx", 1 << 20).ok();
  return 0;
}
