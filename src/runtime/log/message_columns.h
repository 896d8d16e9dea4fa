#pragma once
// Columns that a message of any type makes in a table.

#include <string>
#include <vector>

#include "ros/dynamic_message.h"

namespace gloam {

struct MessageColumn {
  enum class Kind { kReal, kInteger, kText };
  std::string path;  ///< as DynamicMessage takes it
  Kind kind;
};

/// Its numbers and texts in order, arrays element by element; arrays of over 64 bytes are pictures
/// or points and have none. Errors: more than 4096, a damaged message.
Result<std::vector<MessageColumn>> list_columns(const MessageSchema& schema,
                                                const DynamicMessage& message);

}  // namespace gloam
