#include "bridge/zmq/request.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <utility>

#include "gloam/program.h"

namespace gloam::bridge::zeromq {
namespace {

using msgpack::type::object_type;

Error no_request(std::string message) {
  return {.kind = ErrorKind::kUsage,
          .message = std::move(message),
          .hint = "send a map {op: text, id: integer or text, token: text, args: map}"};
}

// Each element takes a byte, so that counts beyond the message's size are refused before memory
// for them is taken.
Result<msgpack::object_handle> unpack_within_limits(std::span<const uint8_t> bytes) {
  const size_t most = bytes.size();
  const msgpack::unpack_limit limit(most, most, most, most, 0, kMaxDepth);
  try {
    std::size_t used = 0;
    msgpack::object_handle whole = msgpack::unpack(reinterpret_cast<const char*>(bytes.data()),
                                                   bytes.size(), used, nullptr, nullptr, limit);
    if (used != bytes.size()) return no_request("there are extra bytes after the msgpack value");
    return whole;
  } catch (const msgpack::insufficient_bytes&) {
    return no_request("the msgpack value is truncated");
  } catch (const msgpack::depth_size_overflow&) {
    return no_request(fmt::format("values are nested more than {} levels deep", kMaxDepth));
  } catch (const std::exception&) {
    return no_request("the bytes are not valid msgpack");
  }
}

/// Finds the value of the key "token" of the outermost map. Parsing ends where a callback returns
/// false.
class TokenFinder : public msgpack::null_visitor {
 public:
  std::string_view token() const { return token_; }

  bool visit_str(const char* text, uint32_t size) {
    const std::string_view value(text, size);
    if (depth_ == 1 && is_key_) key_is_token_ = value == "token";
    if (depth_ == 1 && !is_key_ && key_is_token_) token_ = value;
    return token_.empty();
  }
  bool start_map(uint32_t) { return ++depth_ <= kMaxDepth; }
  bool end_map() {
    --depth_;
    return true;
  }
  bool start_array(uint32_t) { return ++depth_ <= kMaxDepth; }
  bool end_array() {
    --depth_;
    return true;
  }
  bool start_map_key() {
    if (depth_ == 1) is_key_ = true, key_is_token_ = false;
    return true;
  }
  bool end_map_key() {
    if (depth_ == 1) is_key_ = false;
    return true;
  }

 private:
  std::string_view token_;
  int depth_ = 0;
  bool is_key_ = false, key_is_token_ = false;
};

Result<std::string> short_text(const msgpack::object& value, std::string_view key) {
  if (value.type != object_type::STR) return no_request(fmt::format("'{}' is not a string", key));
  if (value.via.str.size > kMaxNameBytes)
    return no_request(fmt::format("'{}' has more than {} bytes", key, kMaxNameBytes));
  return std::string(value.via.str.ptr, value.via.str.size);
}

Status check_id(const msgpack::object& id) {
  const bool is_number =
      id.type == object_type::POSITIVE_INTEGER || id.type == object_type::NEGATIVE_INTEGER;
  if (is_number || id.type == object_type::NIL) return {};
  if (const auto text = short_text(id, "id"); !text.ok())
    return no_request("'id' is neither an integer nor a short string");
  return {};
}

Status check_keys(const msgpack::object& arguments) {
  if (arguments.type != object_type::MAP) return no_request("'args' is not a map");
  for (uint32_t i = 0; i < arguments.via.map.size; ++i)
    GLOAM_TRY_STATUS(short_text(arguments.via.map.ptr[i].key, "key of args"));
  return {};
}

Status take_entry(const std::string& key, const msgpack::object& value, Request* request) {
  if (key == "op") {
    GLOAM_TRY(request->operation, short_text(value, key));
  } else if (key == "token") {
    GLOAM_TRY(request->token, short_text(value, key));
  } else if (key == "id") {
    GLOAM_TRY_STATUS(check_id(value));
    request->id = value;
  } else if (key == "args") {
    GLOAM_TRY_STATUS(check_keys(value));
    request->arguments = value;
  } else {
    const std::array<std::string, 4> keys = {"op", "id", "token", "args"};
    return Error{ErrorKind::kUsage,
                 fmt::format("unknown request key '{}'", key.substr(0, 60)),
                 {},
                 suggest_name(key.substr(0, 60), keys)};
  }
  return {};
}

}  // namespace

Result<Request> parse_request(std::span<const uint8_t> bytes) {
  if (bytes.size() > kMaxRequestBytes)
    return no_request(fmt::format("the request has more than {} bytes", kMaxRequestBytes));
  GLOAM_TRY(msgpack::object_handle whole, unpack_within_limits(bytes));
  Request request;
  request.memory = std::make_shared<msgpack::object_handle>(std::move(whole));
  const msgpack::object& root = request.memory->get();
  if (root.type != object_type::MAP) return no_request("the request is not a map");
  std::vector<std::string> seen;
  for (uint32_t i = 0; i < root.via.map.size; ++i) {
    const msgpack::object_kv& entry = root.via.map.ptr[i];
    GLOAM_TRY(const std::string key, short_text(entry.key, "key"));
    if (std::ranges::count(seen, key) != 0)
      return no_request(fmt::format("'{}' is given twice", key.substr(0, 60)));
    GLOAM_TRY_STATUS(take_entry(key, entry.val, &request));
    seen.push_back(key);
  }
  if (request.operation.empty()) return no_request("the request has no 'op'");
  return request;
}

std::string_view peek_token(std::span<const uint8_t> bytes) {
  TokenFinder finder;
  try {
    msgpack::parse(reinterpret_cast<const char*>(bytes.data()), bytes.size(), finder);
  } catch (const std::exception&) {
    return {};
  }
  return finder.token();
}

PackBuffer error_reply(const msgpack::object& id, const Error& error) {
  PackBuffer buffer;
  Packer packer(buffer);
  packer.pack_map(2);
  pack_pair(packer, "id", id);
  packer.pack(std::string_view("error"));
  pack_error(packer, error);
  return buffer;
}

PackBuffer result_reply(const msgpack::object& id, const PackBuffer& result) {
  PackBuffer buffer(result.size() + 64);
  Packer packer(buffer);
  packer.pack_map(2);
  pack_pair(packer, "id", id);
  packer.pack(std::string_view("result"));
  buffer.write(result.data(), result.size());
  return buffer;
}

}  // namespace gloam::bridge::zeromq
