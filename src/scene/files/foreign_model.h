#pragma once
// Files that are given for models and are something else: errors that name the format and the
// remedy.

#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam {

/// The error of a text that is no XML, or a web page; nothing where it may be a model.
std::optional<Error> find_foreign_text(std::string_view text, const std::string& file);

/// The error of XML whose top element is neither <mujoco> nor <robot>.
Error foreign_element_error(std::string_view top, const std::string& file);

/// Refuses a <robot> without links: an SRDF, or nothing at all.
Status check_is_urdf(const pugi::xml_node& robot, const std::string& file);

}  // namespace gloam
