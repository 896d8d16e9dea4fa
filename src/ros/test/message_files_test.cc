// Types and messages as files, for comparison with others' (tests/e2e/ros_types_test.py): the
// folder GLOAM_ROS_FILES, or a temporary one.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "base/files.h"
#include "ros/codec.h"
#include "ros/message_types.h"
#include "ros/messages/all_messages.h"
#include "ros/test/random_message.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr uint64_t kMessages = 8;  // of each type

std::string file_name(std::string name) {
  std::ranges::replace(name, '/', '.');
  return name;
}

fs::path shared_folder() {
  const char* folder = std::getenv("GLOAM_ROS_FILES");
  return folder != nullptr ? fs::path(folder) : fs::path(testing::TempDir()) / "gloam_ros_files";
}

/// Decodes what others wrote and writes it again, beside it.
template <Message T>
void echo(const fs::path& folder, std::string_view name) {
  for (uint64_t i = 0; i < kMessages; ++i) {
    const std::string base = file_name(std::string(name)) + "." + std::to_string(i);
    const auto theirs = read_file(folder / (base + ".theirs"));
    if (!theirs.ok()) return;
    const Result<T> message = decode<T>(*theirs);
    ASSERT_TRUE(message.ok()) << message.error().to_string();
    std::vector<uint8_t> bytes;
    encode(*message, &bytes);
    ASSERT_TRUE(write_file_atomic(folder / (base + ".echo"), bytes).ok());
  }
}

TEST(MessageFiles, AreWrittenAndOthersAreReadAndWrittenAgain) {
  const fs::path folder = shared_folder();
  ASSERT_TRUE(make_folder(folder).ok());
  std::string hashes;
  AllMessages::for_each([&]<class T>(std::type_identity<T>) {
    const MessageType& type = message_type<T>();
    hashes += type.name + " " + type.hash + "\n";
    const fs::path file = folder / file_name(type.name);
    ASSERT_TRUE(write_text_file_atomic(file.string() + ".msg", type.text).ok());
    for (uint64_t i = 0; i < kMessages; ++i) {
      std::vector<uint8_t> bytes;
      encode(random_message<T>(i), &bytes);
      ASSERT_TRUE(write_file_atomic(file.string() + "." + std::to_string(i) + ".ours", bytes).ok());
    }
    echo<T>(folder, type.name);
  });
  ASSERT_TRUE(write_text_file_atomic(folder / "hashes.txt", hashes).ok());
}

}  // namespace
}  // namespace gloam
