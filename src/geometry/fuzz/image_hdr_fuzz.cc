#include "geometry/image/image_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  (void)gloam::decode_hdr({data, size}, "fuzz.hdr", 1 << 20).ok();
  return 0;
}
