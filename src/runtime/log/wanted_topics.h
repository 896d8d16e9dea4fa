#pragma once
// Topics of a log, of those that a simulation has.

#include <vector>

#include "gloam/log.h"
#include "topics/topic_table.h"

namespace gloam {

/// Rows of the table that a log has: those that are asked for, else the usual ones. Error: there is
/// no such topic.
Result<std::vector<const Topic*>> wanted_topics(const TopicTable& table,
                                                const std::vector<std::string>& patterns);

/// Whether a log has topics that are made of pictures. Error: no such topic.
Result<bool> logs_pictures(const World& world, const LogRequest& request);

}  // namespace gloam
