#pragma once
// The page's files (studio/bundle/), built into the library.

#include <string>
#include <string_view>

#include "web/websocket_server.h"

namespace gloam::studio {

struct PageFile {
  std::string_view path;  ///< as in the address: "/" or "/app.js"
  std::string_view type;  ///< media type
  std::string_view bytes;
};

/// Null when there is no such file.
const PageFile* find_page_file(std::string_view path);

/// The page's files, and its WebSocket at /ws, for clients that have the token.
web::Answer answer_page_request(const web::RequestFacts& request, const std::string& token);

}  // namespace gloam::studio
