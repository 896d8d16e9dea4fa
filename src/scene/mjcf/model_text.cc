#include "scene/mjcf/model_text.h"

#include <algorithm>

#include "base/check.h"

namespace gloam {
namespace {

using mjcf::Element;

// `written` is `made` as it was read back: element by element the same.
void find_lines(const Element& made, const Element& written, std::vector<int>* lines) {
  const auto line = static_cast<size_t>(written.loc().line);
  if (line >= lines->size()) lines->resize(line + 1);
  if ((*lines)[line] == 0) (*lines)[line] = made.loc().line;
  const std::vector<Element> here = made.children(), there = written.children();
  GLOAM_CHECK(here.size() == there.size(),
              "a document does not match its source after a round trip");
  for (size_t i = 0; i < here.size(); ++i) find_lines(here[i], there[i], lines);
}

}  // namespace

Result<ModelText> translate_model(std::string_view toml, const std::string& file) {
  GLOAM_TRY(mjcf::Document document, mjcf::Document::from_toml(toml, file));
  GLOAM_TRY_STATUS(document.check());
  ModelText text{document, document.to_xml(), {}};
  GLOAM_TRY(const mjcf::Document written, mjcf::Document::from_xml(text.xml, file));
  find_lines(text.document.root(), written.root(), &text.lines);
  for (size_t i = 1; i < text.lines.size(); ++i) {
    if (text.lines[i] == 0) text.lines[i] = text.lines[i - 1];
  }
  return text;
}

}  // namespace gloam
