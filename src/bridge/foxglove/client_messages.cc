#include "bridge/foxglove/client_messages.h"

#include <cmath>
#include <cstring>
#include <limits>

#include "web/client_json.h"

namespace gloam::bridge::foxglove {
namespace {

using nlohmann::json;

Error malformed(std::string message) { return {ErrorKind::kInput, std::move(message)}; }

/// Reads fields of one message and remembers the first thing that is wrong.
class FieldReader {
 public:
  explicit FieldReader(const json& object) : object_(object) {}

  /// An integer of 0 … `most`.
  uint64_t number(const char* key, uint64_t most) {
    const json* value = find(key);
    return value != nullptr ? as_id(*value, key, most) : 0;
  }
  uint32_t id(const char* key) { return static_cast<uint32_t>(number(key, kMostId)); }
  std::string text(const char* key) {
    const json* value = find(key);
    return value != nullptr ? as_text(*value, key) : "";
  }
  std::string optional_text(const char* key) { return object_.contains(key) ? text(key) : ""; }
  std::vector<uint32_t> ids(const char* key) {
    std::vector<uint32_t> ids;
    for_each(key, [&](const json& item) {
      ids.push_back(static_cast<uint32_t>(as_id(item, key, kMostId)));
    });
    return ids;
  }
  std::vector<std::string> texts(const char* key) {
    std::vector<std::string> texts;
    for_each(key, [&](const json& item) { texts.push_back(as_text(item, key)); });
    return texts;
  }
  /// Calls visit(FieldReader&, object) for each object of a list.
  template <class Visit>
  void objects(const char* key, Visit visit) {
    for_each(key, [&](const json& item) {
      if (!item.is_object()) return fail(key, "must be a list of objects");
      FieldReader reader(item);
      visit(reader, item);
      if (problem_.empty()) problem_ = reader.problem_;
    });
  }
  Result<ClientMessage> finish(ClientMessage message) const {
    if (!problem_.empty()) return malformed(problem_);
    return message;
  }

 private:
  static constexpr uint64_t kMostId = std::numeric_limits<uint32_t>::max();

  void fail(const char* key, const char* what) {
    if (problem_.empty()) problem_ = "'" + std::string(key) + "' " + what;
  }
  const json* find(const char* key) {
    const auto found = object_.find(key);
    if (found != object_.end()) return &*found;
    fail(key, "is missing");
    return nullptr;
  }
  uint64_t as_id(const json& value, const char* key, uint64_t most) {
    // JavaScript's numbers may arrive with a fraction of zero.
    if (value.is_number_float()) {
      const double number = value.get<double>();
      if (number >= 0 && number <= static_cast<double>(most) && number == std::floor(number))
        return static_cast<uint64_t>(number);
    } else if (value.is_number_unsigned() && value.get<uint64_t>() <= most) {
      return value.get<uint64_t>();
    }
    fail(key, "must be an integer within its range");
    return 0;
  }
  std::string as_text(const json& value, const char* key) {
    if (!value.is_string()) {
      fail(key, "must be a string");
      return {};
    }
    auto text = value.get<std::string>();
    if (text.size() > kLongestName) fail(key, "is too long");
    return text;
  }
  template <class Visit>
  void for_each(const char* key, Visit visit) {
    const json* list = find(key);
    if (list == nullptr) return;
    if (!list->is_array()) return fail(key, "must be a list");
    if (list->size() > kMostItems) return fail(key, "is too long");
    for (const json& item : *list) visit(item);
  }

  const json& object_;
  std::string problem_;
};

constexpr uint64_t kMostChannel = uint64_t{1} << 53;  // what a number of JavaScript holds

Result<ClientMessage> read_subscribe(FieldReader reader) {
  SubscribeMessage message;
  reader.objects("subscriptions", [&](FieldReader& item, const json&) {
    message.items.push_back({item.id("id"), item.number("channelId", kMostChannel)});
  });
  return reader.finish(std::move(message));
}

Result<ClientMessage> read_advertise(FieldReader reader) {
  AdvertiseMessage message;
  reader.objects("channels", [&](FieldReader& item, const json&) {
    message.channels.push_back({item.id("id"), item.text("topic"), item.text("encoding"),
                                item.optional_text("schemaName")});
  });
  return reader.finish(std::move(message));
}

Result<ClientMessage> read_set_parameters(FieldReader reader) {
  SetParametersMessage message;
  reader.objects("parameters", [&](FieldReader& item, const json& object) {
    message.parameters.push_back({item.text("name"), object.value("value", json())});
  });
  message.request = reader.optional_text("id");
  return reader.finish(std::move(message));
}

Result<ClientMessage> read_get_parameters(FieldReader reader) {
  GetParametersMessage message{reader.texts("parameterNames"), reader.optional_text("id")};
  return reader.finish(std::move(message));
}

Result<ClientMessage> read_fetch_asset(FieldReader reader) {
  FetchAssetMessage message{reader.text("uri"), reader.id("requestId")};
  return reader.finish(std::move(message));
}

/// Little-endian numbers out of bytes that may end too early.
class ByteReader {
 public:
  explicit ByteReader(std::span<const uint8_t> bytes) : rest_(bytes) {}

  template <class T>
  T number() {
    T value = {};
    if (rest_.size() < sizeof value) {
      ok_ = false;
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_ = rest_.subspan(sizeof value);
    return value;
  }
  std::string text() {
    const auto size = number<uint32_t>();
    if (size > rest_.size() || size > kLongestName) {
      ok_ = false;
      return {};
    }
    std::string text(reinterpret_cast<const char*>(rest_.data()), size);
    rest_ = rest_.subspan(size);
    return text;
  }
  std::span<const uint8_t> rest() const { return rest_; }
  bool ok() const { return ok_; }

 private:
  std::span<const uint8_t> rest_;
  bool ok_ = true;
};

}  // namespace

Result<ClientMessage> parse_text_message(std::string_view text) {
  const json object = web::parse_client_json(text);
  if (object.is_discarded()) return malformed("the message is not JSON");
  const auto found = object.is_object() ? object.find("op") : object.end();
  if (!object.is_object() || found == object.end() || !found->is_string())
    return malformed("the message must be an object with a string 'op'");
  FieldReader reader(object);
  const auto& op = found->get_ref<const std::string&>();
  if (op == "subscribe") return read_subscribe(std::move(reader));
  if (op == "unsubscribe") return reader.finish(UnsubscribeMessage{reader.ids("subscriptionIds")});
  if (op == "advertise") return read_advertise(std::move(reader));
  if (op == "unadvertise") return reader.finish(UnadvertiseMessage{reader.ids("channelIds")});
  if (op == "getParameters") return read_get_parameters(std::move(reader));
  if (op == "setParameters") return read_set_parameters(std::move(reader));
  if (op == "subscribeParameterUpdates" || op == "unsubscribeParameterUpdates")
    return reader.finish(WatchParametersMessage{reader.texts("parameterNames"), op[0] == 's'});
  if (op == "subscribeConnectionGraph") return ClientMessage(WatchGraphMessage{true});
  if (op == "unsubscribeConnectionGraph") return ClientMessage(WatchGraphMessage{false});
  if (op == "fetchAsset") return read_fetch_asset(std::move(reader));
  return malformed("unknown op '" + op.substr(0, 64) + "'");
}

Result<ClientMessage> parse_binary_message(std::span<const uint8_t> bytes) {
  ByteReader reader(bytes);
  const auto opcode = reader.number<uint8_t>();
  ClientMessage message;
  switch (opcode) {
    case 1: {
      const auto channel = reader.number<uint32_t>();
      message = PublishMessage{channel, reader.rest()};
      break;
    }
    case 2: {
      CallMessage call;
      call.service = reader.number<uint32_t>();
      call.call = reader.number<uint32_t>();
      call.encoding = reader.text();
      call.data = reader.rest();
      message = std::move(call);
      break;
    }
    case 3: {
      PlaybackMessage playback;
      const auto command = reader.number<uint8_t>();
      if (command > 1) return malformed("the playback command must be 0 (play) or 1 (pause)");
      playback.play = command == 0;
      playback.speed = reader.number<float>();
      const bool seeks = reader.number<uint8_t>() != 0;
      const auto time = reader.number<uint64_t>();
      if (seeks) playback.seek = time;
      playback.request = reader.text();
      if (!std::isfinite(playback.speed)) return malformed("the playback speed is not finite");
      message = std::move(playback);
      break;
    }
    default:
      return malformed("unknown binary opcode " + std::to_string(opcode));
  }
  if (!reader.ok()) return malformed("the binary message is too short");
  return message;
}

}  // namespace gloam::bridge::foxglove
