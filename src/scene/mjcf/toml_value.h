#pragma once
// Values of MJCF's attributes as TOML has them.

#include <toml++/toml.h>

#include <optional>
#include <string>

#include "scene/mjcf/schema.h"

namespace gloam {

/// As it would be written in XML; nothing if TOML holds what no attribute takes.
std::optional<std::string> mjcf_text(const toml::node& node);

/// Keyword of MJCF for `true` and `false`, such as enable and disable.
std::string mjcf_keyword(const MjcfAttribute& attribute, std::string text);

}  // namespace gloam
