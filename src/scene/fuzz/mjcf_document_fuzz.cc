// Any bytes as MJCF or as its TOML form: what is read is written so that it is read again, the
// same.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string_view>

#include "base/test/custom_mutator.h"
#include "gloam/mjcf.h"
#include "scene/test/toml_mutator.h"
#include "scene/test/xml_mutator.h"

using gloam::Result;
using gloam::mjcf::Document;
using gloam::mjcf::Element;

namespace {

size_t values_in(const Element& element) {
  size_t count = 1 + element.given().size();
  for (const Element& child : element.children()) count += values_in(child);
  return count;
}

void require(bool fact, const Result<Document>& read, const std::string& written) {
  if (fact) return;
  std::fprintf(stderr, "%s\n%s\n", read.ok() ? "differs" : read.error().to_string().c_str(),
               written.c_str());
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto document =
      text.starts_with('<') ? Document::from_xml(text) : Document::from_toml(text);
  if (!document.ok()) return 0;
  (void)document->check().ok();
  const std::string xml = document->to_xml(), toml = document->to_toml();
  const auto by_xml = Document::from_xml(xml);
  require(by_xml.ok() && by_xml->to_xml() == xml, by_xml, xml);
  const auto by_toml = Document::from_toml(toml);
  require(by_toml.ok() && values_in(by_toml->root()) == values_in(document->root()), by_toml, toml);
  const auto again = Document::from_toml(by_toml->to_toml());
  require(again.ok() && again->to_xml() == by_toml->to_xml(), again, by_toml->to_toml());
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned seed) {
  return gloam::mutate_structure(data, size, max_size, seed,
                                 [](const std::string& text, unsigned seed) {
                                   return text.starts_with('<') ? gloam::mutate_xml(text, seed)
                                                                : gloam::mutate_toml(text, seed);
                                 });
}
