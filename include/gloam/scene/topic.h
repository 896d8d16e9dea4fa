#pragma once
// Changes to the table of topics (gloam/topics.h). Part of gloam/scene.h.

#include <optional>
#include <string>

#include "gloam/result.h"
#include "gloam/types.h"

namespace gloam {

/// [[topic]]: changes one or several topics from the default rules (docs/topics.md). A later table
/// takes precedence.
struct TopicOptions {
  std::string name = {};              ///< default name, "/front/points"; * matches any text
  std::string rename = {};            ///< new name; empty = unchanged
  std::string frame = {};             ///< new frame_id; empty = unchanged
  std::optional<Rational> rate = {};  ///< messages per second of simulation time [Hz]
  std::optional<bool> log = {};       ///< recorded by logs that do not name topics
  std::optional<bool> off = {};       ///< neither published nor accepted
  SourceLoc loc = {};
};

}  // namespace gloam
