#pragma once
// Values of fields that a message in JSON or Python does not name.

#include "ros/cdr.h"
#include "ros/message_schema.h"

namespace gloam {

/// Writes the default that the definition (.msg) gives to a field, else zero, an empty text, an
/// empty sequence, or a message of the defaults of its fields.
void write_default(const MessageSchema& schema, const MessageSchema::Field& field,
                   CdrWriter* writer);

}  // namespace gloam
