#pragma once
// Description of a log for people: `gloam info LOG`.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mcap/mcap_reader.h"

namespace gloam {

struct McapTopicInfo {
  std::string topic, type;  ///< "/tf", "tf2_msgs/msg/TFMessage"
  std::string encoding;     ///< of its messages: "cdr"
  uint64_t messages = 0;
  double rate = 0;  ///< mean over the whole log [Hz]; 0 = fewer than two messages
};

struct McapInfo {
  std::string profile, library;
  uint64_t bytes = 0, messages = 0;
  uint64_t start_time = 0, end_time = 0;  ///< [ns]
  double duration = 0;                    ///< [s]
  std::vector<McapTopicInfo> topics;      ///< by name; a topic of several channels has several
  uint64_t chunks = 0;
  std::map<std::string, uint64_t> chunks_by_compression;  ///< "" = none
  double compression_ratio = 1;  ///< bytes of all chunks' records over those in the log
  std::vector<McapAttachmentIndex> attachments;
  std::vector<std::string> metadata;  ///< names
  bool by_summary = false;
  std::string damage;  ///< empty = none met
};

McapInfo describe(const McapReader& reader);

}  // namespace gloam
