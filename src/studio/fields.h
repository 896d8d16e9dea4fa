#pragma once
// Fields of MuJoCo's model and data as binary messages: docs/view_protocol.md.

#include <cstdint>
#include <string>
#include <vector>

#include "gloam/snapshot.h"

namespace gloam::studio {

struct FieldsMessage {
  std::vector<uint8_t> bytes;
  std::vector<std::string> problems;  ///< one for each field that is not in it
};

/// Values of `fields` at the instant that `instant` has solved from `snapshot`. Problems: no such
/// field, more values than a message takes.
FieldsMessage encode_fields(const std::vector<std::string>& fields, int id,
                            const Snapshot& snapshot, const Instant& instant);

}  // namespace gloam::studio
