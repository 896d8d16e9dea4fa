#pragma once
// Reports of `gloam info` on logs and topics.

#include <string>

#include "command.h"

namespace gloam::cli {

/// By its name.
bool is_log(const std::string& file);
int report_log(const std::string& file, const Globals& globals);
int report_topics(const World& world, const Globals& globals);

}  // namespace gloam::cli
