// Any bytes as an ONNX file: they are rejected with a reason, or their declarations are bounded.

#include <cstdint>
#include <cstdlib>
#include <span>

#include "policy/onnx/onnx_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const auto file = gloam::parse_onnx(std::span(data, size), "fuzz.onnx");
  if (!file.ok() && file.error().message.empty()) std::abort();
  if (file.ok() && file->inputs.size() > 1000) std::abort();
  return 0;
}
