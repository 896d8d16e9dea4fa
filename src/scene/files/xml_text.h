#pragma once
// XML as pugixml reads it, with the lines of its elements.

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/nesting.h"
#include "gloam/result.h"

namespace gloam {

/// Line numbers of offsets into a text.
class XmlLines {
 public:
  explicit XmlLines(std::string_view text);
  int at(ptrdiff_t offset) const;  ///< from 1

 private:
  std::vector<ptrdiff_t> ends_;
};

/// `options` are pugixml's parse_… flags. Errors with `file` and line: empty, not
/// well-formed, beyond the limits of nesting.h.
Status parse_xml(std::string_view text, const std::string& file, unsigned options,
                 pugi::xml_document* document);

}  // namespace gloam
