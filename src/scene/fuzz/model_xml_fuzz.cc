// Any bytes as a model's XML: the scan bounds them and the URDF rewriter survives them. (MuJoCo's
// own parser is not fuzzed here.)

#include <cstdint>
#include <cstdlib>
#include <string>

#include "base/test/custom_mutator.h"
#include "scene/files/urdf_text.h"
#include "scene/files/xml_scan.h"
#include "scene/test/xml_mutator.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto scan = gloam::scan_model_xml(text, "fuzz.xml");
  if (!scan.ok()) {
    if (scan.error().message.empty()) std::abort();
    return 0;
  }
  for (const gloam::FileReference& reference : scan->references) {
    if (!gloam::has_element_at(text, reference.element, reference.line)) std::abort();
  }
  (void)gloam::line_of_element_with(text, "", {"name", "x"});
  bool answer = false;
  const auto exists = [&](const std::filesystem::path&) { return answer = !answer; };
  (void)gloam::prepare_urdf(text, "/models/fuzz.urdf", {}, exists).ok();
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  return gloam::mutate_structure(data, size, max_size, seed, gloam::mutate_xml);
}
