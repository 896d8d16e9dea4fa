#pragma once
// A client of Foxglove's protocol by hand, so that tests can misbehave.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "web/test/raw_client.h"

namespace gloam::bridge::foxglove {

class FoxgloveClient : public web::RawClient {
 public:
  using RawClient::RawClient;

  /// Becomes a WebSocket; the HTTP status: 101 when it worked. `headers`: "Name: value\r\n" each,
  /// besides those that every client sends.
  int upgrade(std::string_view target, std::string_view protocols, std::string_view headers = "");

  /// Next text message with this "op"; others are skipped.
  std::optional<nlohmann::json> wait_for(std::string_view op, double seconds = 10);
  /// Next binary message with this opcode, without it.
  std::optional<std::string> wait_for_binary(uint8_t opcode, double seconds = 10);
  /// The same of a subscription's data: the payload behind id and time.
  std::optional<std::string> wait_for_data(uint32_t subscription, double seconds = 10);

 private:
  std::optional<Frame> find(const std::function<bool(const Frame&)>& fits, double seconds);
};

/// A folder for files of this process: test programs may run beside each other.
inline std::filesystem::path own_folder() {
  const auto folder =
      std::filesystem::path(testing::TempDir()) / ("gloam_foxglove_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  return folder;
}

/// A number out of a binary message.
template <class T>
T number_at(std::string_view bytes, size_t at) {
  T value = {};
  if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}
template <class T>
std::string as_bytes(T value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace gloam::bridge::foxglove
