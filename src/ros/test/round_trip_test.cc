// Every message with random contents: encoded and decoded, cut at every byte, damaged.

#include <gtest/gtest.h>

#include "base/test/mutator.h"
#include "ros/codec.h"
#include "ros/dynamic_message.h"
#include "ros/message_types.h"
#include "ros/messages/all_messages.h"
#include "ros/test/random_message.h"

namespace gloam {
namespace {

template <class F>
void for_each_message(F&& f) {
  AllMessages::for_each([&]<class T>(std::type_identity<T> type) {
    SCOPED_TRACE(ros_type_name<T>());
    f(type);
  });
}

TEST(RoundTrip, EveryMessageComesBack) {
  for_each_message([]<class T>(std::type_identity<T>) {
    for (uint64_t seed = 0; seed < 50; ++seed) {
      const T message = random_message<T>(seed);
      std::vector<uint8_t> bytes;
      encode(message, &bytes);
      const Result<T> back = decode<T>(bytes);
      ASSERT_TRUE(back.ok()) << back.error().to_string();
      ASSERT_EQ(*back, message);
      ASSERT_GE(bytes.size(), kCdrHead + least_cdr_size<T>());
    }
  });
}

TEST(RoundTrip, NoMessageThatIsCutIsRead) {
  for_each_message([]<class T>(std::type_identity<T>) {
    const MessageSchema schema = MessageSchema::create(describe<T>()).value();
    std::vector<uint8_t> bytes;
    for (uint64_t seed = 0; seed < 3; ++seed) {
      encode(random_message<T>(seed), &bytes);
      for (size_t size = 0; size < bytes.size(); ++size) {
        // A copy of its own, so that a sanitizer sees reads beyond its end.
        const std::vector<uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<ptrdiff_t>(size));
        ASSERT_FALSE(decode<T>(cut).ok()) << size << " of " << bytes.size();
        ASSERT_FALSE(DynamicMessage::open(schema, cut).ok()) << size << " of " << bytes.size();
      }
    }
  });
}

// Damage gives an error of one line, or a value that is what its bytes say; the reader of any type
// agrees with that of structs.
TEST(Mutations, MessagesDoNoHarm) {
  size_t read = 0, refused = 0;
  for_each_message([&]<class T>(std::type_identity<T>) {
    const MessageSchema schema = MessageSchema::create(describe<T>()).value();
    std::vector<uint8_t> bytes;
    for (uint64_t seed = 0; seed < mutation_count(); ++seed) {
      encode(random_message<T>(seed), &bytes);
      const std::string text = Mutator(seed).mutate(std::string(bytes.begin(), bytes.end()));
      const std::vector<uint8_t> damaged(text.begin(), text.end());
      const Result<T> message = decode<T>(damaged);
      ASSERT_EQ(message.ok(), DynamicMessage::open(schema, damaged).ok()) << seed;
      if (!message.ok()) {
        ++refused;
        ASSERT_EQ(message.error().to_string().find('\n'), std::string::npos);
        continue;
      }
      ++read;
      std::vector<uint8_t> first, second;
      encode(*message, &first);
      const Result<T> again = decode<T>(first);
      ASSERT_TRUE(again.ok()) << again.error().to_string();
      encode(*again, &second);
      ASSERT_EQ(first, second);
    }
  });
  EXPECT_GT(refused, read / 10);
  EXPECT_GT(read, refused / 10);
}

}  // namespace
}  // namespace gloam
