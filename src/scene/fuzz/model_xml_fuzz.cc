// Any bytes as a model's XML: the scan bounds them and the URDF rewriter survives them. (MuJoCo's
// own parser is not fuzzed here.)

#include <cstdint>
#include <cstdlib>
#include <string>

#include "scene/files/urdf_text.h"
#include "scene/files/xml_scan.h"

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
