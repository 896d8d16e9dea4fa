#pragma once
// The page's files (studio/web/), built into the library.

#include <string_view>

namespace gloam::studio {

struct PageFile {
  std::string_view path;  ///< as in the address: "/" or "/app.js"
  std::string_view type;  ///< media type
  std::string_view bytes;
};

/// Null when there is no such file.
const PageFile* find_page_file(std::string_view path);

}  // namespace gloam::studio
