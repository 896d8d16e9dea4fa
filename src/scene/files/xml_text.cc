#include "scene/files/xml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace gloam {

XmlLines::XmlLines(std::string_view text) {
  for (size_t i = text.find('\n'); i != std::string_view::npos; i = text.find('\n', i + 1))
    ends_.push_back(static_cast<ptrdiff_t>(i));
}

int XmlLines::at(ptrdiff_t offset) const {
  return static_cast<int>(std::ranges::lower_bound(ends_, offset) - ends_.begin()) + 1;
}

Status parse_xml(std::string_view text, const std::string& file, unsigned options,
                 pugi::xml_document* document) {
  GLOAM_TRY_STATUS(check_excess(xml_excess(text), text, file));
  const pugi::xml_parse_result parsed =
      document->load_buffer(text.data(), text.size(), options, pugi::encoding_utf8);
  if (parsed) return {};
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    return Error{ErrorKind::kInput, "the file is empty", {file, 0, 0}};
  std::string what = parsed.description();
  if (!what.empty()) what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
  return Error{ErrorKind::kInput,
               fmt::format("is not well-formed XML: {}", what),
               {file, XmlLines(text).at(parsed.offset), 0}};
}

}  // namespace gloam
