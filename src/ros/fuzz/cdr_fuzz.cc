// A message of one of our types, chosen by the first byte: the readers of structs and of any type
// agree, and what was read survives being written.

#include <cstdlib>

#include "ros/codec.h"
#include "ros/dynamic_message.h"
#include "ros/messages/all_messages.h"

namespace {

template <gloam::Message T>
void check(std::span<const uint8_t> bytes) {
  static const gloam::MessageSchema schema =
      gloam::MessageSchema::create(gloam::describe<T>()).value();
  const gloam::Result<T> message = gloam::decode<T>(bytes);
  const gloam::Result<gloam::DynamicMessage> any = gloam::DynamicMessage::open(schema, bytes);
  if (message.ok() != any.ok()) std::abort();
  if (!message.ok()) {
    if (message.error().to_string().find('\n') != std::string::npos) std::abort();
    return;
  }
  for (const auto& field : schema.fields(0)) (void)any->numbers(field.name).ok();
  std::vector<uint8_t> first, second;
  gloam::encode(*message, &first);
  const gloam::Result<T> again = gloam::decode<T>(first);
  if (!again.ok()) std::abort();
  gloam::encode(*again, &second);
  if (first != second) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  size_t type = 0;
  gloam::AllMessages::for_each([&]<class T>(std::type_identity<T>) {
    if (type++ == data[0]) check<T>({data + 1, size - 1});
  });
  return 0;
}
