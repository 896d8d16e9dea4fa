#pragma once
// Changes to the table of topics (gloam/topics.h). Part of gloam/scene.h.

#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[topic]]: one topic, or several, otherwise than by the default rules (docs/topics.md). A later
/// line wins.
struct TopicOptions {
  std::string name = {};              ///< name by the rules, "/front/points"; * stands for any text
  std::string rename = {};            ///< name instead; empty = as it is
  std::string frame = {};             ///< frame_id instead; empty = as it is
  std::optional<Rational> rate = {};  ///< messages per second of simulation time [Hz]
  std::optional<bool> log = {};       ///< written to logs that name no topics
  std::optional<bool> off = {};       ///< neither said nor heard
  SourceLoc loc = {};
};

}  // namespace gloam
