#include "studio/messages.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "web/client_json.h"

namespace gloam::studio {
namespace {

using nlohmann::json;

Error wrong(std::string message) {
  return {.kind = ErrorKind::kInput, .message = std::move(message)};
}

/// Reads the values of one message and remembers the first thing that is wrong with it.
class Reader {
 public:
  explicit Reader(const json& object) : object_(object) {}

  double number(const char* key, double low, double high) {
    const json* found = find(key);
    if (found == nullptr || !found->is_number()) return fail(key, "must be a number");
    return in_range(key, found->get<double>(), low, high);
  }
  int integer(const char* key, int low, int high) {
    const double value = number(key, low, high);
    if (value != std::floor(value)) fail(key, "must be an integer");
    return static_cast<int>(value);
  }
  bool flag(const char* key) {
    const json* found = find(key);
    if (found == nullptr || !found->is_boolean()) return fail(key, "must be true or false") != 0;
    return found->get<bool>();
  }
  bool has(const char* key) const { return object_.contains(key); }
  std::string text(const char* key, size_t max_size) {
    const json* found = find(key);
    if (found == nullptr || !found->is_string()) {
      fail(key, "must be a string");
      return {};
    }
    auto value = found->get<std::string>();
    if (value.size() > max_size) fail(key, "is too long");
    return value;
  }
  /// Index of a word of a list.
  size_t word(const char* key, std::initializer_list<std::string_view> words) {
    constexpr size_t kLongest = 64;
    const auto found = std::ranges::find(words, text(key, kLongest));
    if (found == words.end()) fail(key, "is not one of the words that are allowed");
    return static_cast<size_t>(found - words.begin());
  }
  std::vector<double> numbers(const char* key, size_t most, double limit) {
    std::vector<double> values;
    each(key, most, [&](const json& item) {
      if (!item.is_number()) return void(fail(key, "must be a list of numbers"));
      values.push_back(in_range(key, item.get<double>(), -limit, limit));
    });
    return values;
  }
  std::vector<std::string> texts(const char* key, size_t most, size_t max_size) {
    std::vector<std::string> values;
    each(key, most, [&](const json& item) {
      if (!item.is_string()) return void(fail(key, "must be a list of strings"));
      values.push_back(item.get<std::string>());
      if (values.back().size() > max_size) fail(key, "has a string that is too long");
    });
    return values;
  }

  Result<ControlMessage> finish(ControlMessage message) const {
    if (!problem_.empty()) return wrong(problem_);
    if (object_.size() != read_ + 1)
      return wrong("the message has a key that is unknown for its type");
    return message;
  }

 private:
  const json* find(const char* key) {
    ++read_;
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  template <class Use>
  void each(const char* key, size_t most, Use use) {
    const json* found = find(key);
    if (found == nullptr || !found->is_array()) return void(fail(key, "must be a list"));
    if (found->size() > most) return void(fail(key, "has too many items"));
    for (const json& item : *found) use(item);
  }
  double in_range(const char* key, double value, double low, double high) {
    if (!std::isfinite(value) || value < low || value > high) return fail(key, "is out of range");
    return value;
  }
  double fail(const char* key, const char* what) {
    if (problem_.empty()) problem_ = "'" + std::string(key) + "' " + what;
    return 0;
  }

  const json& object_;
  size_t read_ = 0;
  std::string problem_;
};

constexpr double kMaxTravel = 100;    // picture heights in one message
constexpr double kMaxPixel = 100000;  // beyond any picture, inside or outside of it
constexpr double kMaxNumber = 1e10;   // MuJoCo's limit of positions, mjMAXVAL
constexpr int kMaxIndex = 1 << 30;
constexpr size_t kMaxName = 1024, kMaxStateText = size_t{60} << 10;

template <class Message>
Message point(Reader& r) {
  Message message;
  message.u = r.number("u", -kMaxPixel, kMaxPixel);
  message.v = r.number("v", -kMaxPixel, kMaxPixel);
  if (r.has("width")) message.width = r.integer("width", 1, static_cast<int>(kMaxPixel));
  return message;
}

template <class Message>
Message travel(Reader& r) {
  return {r.number("dx", -kMaxTravel, kMaxTravel), r.number("dy", -kMaxTravel, kMaxTravel)};
}

template <class Message>
Message nothing(Reader&) {
  return {};
}

DragStartMessage drag_start(Reader& r) {
  auto message = point<DragStartMessage>(r);
  message.turn = r.has("turn") && r.flag("turn");
  return message;
}

DriveMessage drive(Reader& r) {
  const auto speed = [&](const char* key) { return r.number(key, -kMaxNumber, kMaxNumber); };
  return {r.integer("robot", 0, kMaxIndex), speed("vx"), speed("vy"), speed("yaw_rate"),
          speed("vz")};
}

std::vector<std::string> fields(Reader& r) { return r.texts("fields", kMaxFields, kMaxName); }

int index(Reader& r, const char* key) { return r.integer(key, 0, kMaxIndex); }

struct MessageType {
  const char* name;
  ControlMessage (*read)(Reader&);
};

template <class Message, auto kRead = nothing<Message>>
ControlMessage read_as(Reader& reader) {
  return Message(kRead(reader));
}

StepMessage step(Reader& r) { return {r.integer("count", 1, kMaxStepCount)}; }
BackMessage back(Reader& r) { return {r.integer("count", 1, kMaxStepCount)}; }
SpeedMessage speed(Reader& r) { return {r.number("value", kMinSpeed, kMaxSpeed)}; }
SeekMessage seek(Reader& r) { return {r.number("time", 0, kMaxTime)}; }
SetJointMessage set_joint(Reader& r) {
  return {index(r, "joint"), r.numbers("qpos", 7, kMaxNumber)};
}
SetControlMessage set_control(Reader& r) {
  return {index(r, "actuator"), r.number("value", -kMaxNumber, kMaxNumber)};
}
SetEqualityMessage set_equality(Reader& r) { return {index(r, "equality"), r.flag("active")}; }
LoadKeyframeMessage load_keyframe(Reader& r) { return {index(r, "keyframe")}; }
PasteStateMessage paste_state(Reader& r) { return {r.text("text", kMaxStateText)}; }
CameraMessage camera(Reader& r) { return {r.text("name", kMaxName)}; }
ZoomMessage zoom(Reader& r) { return {r.number("amount", -10, 10)}; }
TrackMessage track(Reader& r) { return {r.integer("body", -1, kMaxIndex)}; }
GetMessage get(Reader& r) { return {r.integer("id", 1, kMaxIndex), fields(r)}; }
CodecMessage codec(Reader& r) { return {r.word("name", {"jpeg", "h264"}) == 1}; }
WatchMessage watch(Reader& r) {
  return {fields(r), r.number("rate", kMinWatchRate, kMaxWatchRate)};
}

constexpr MessageType kTypes[] = {
    {"seen", read_as<SeenMessage>},
    {"pause", read_as<PauseMessage>},
    {"resume", read_as<ResumeMessage>},
    {"step", read_as<StepMessage, step>},
    {"back", read_as<BackMessage, back>},
    {"speed", read_as<SpeedMessage, speed>},
    {"reset", read_as<ResetMessage>},
    {"seek", read_as<SeekMessage, seek>},
    {"set_joint", read_as<SetJointMessage, set_joint>},
    {"set_control", read_as<SetControlMessage, set_control>},
    {"clear_controls", read_as<ClearControlsMessage>},
    {"set_equality", read_as<SetEqualityMessage, set_equality>},
    {"load_keyframe", read_as<LoadKeyframeMessage, load_keyframe>},
    {"copy_state", read_as<CopyStateMessage>},
    {"paste_state", read_as<PasteStateMessage, paste_state>},
    {"drive", read_as<DriveMessage, drive>},
    {"camera", read_as<CameraMessage, camera>},
    {"orbit", read_as<OrbitMessage, travel<OrbitMessage>>},
    {"pan", read_as<PanMessage, travel<PanMessage>>},
    {"zoom", read_as<ZoomMessage, zoom>},
    {"look_at", read_as<LookAtMessage, point<LookAtMessage>>},
    {"track", read_as<TrackMessage, track>},
    {"pick", read_as<PickMessage, point<PickMessage>>},
    {"drag_start", read_as<DragStartMessage, drag_start>},
    {"drag_move", read_as<DragMoveMessage, point<DragMoveMessage>>},
    {"drag_end", read_as<DragEndMessage>},
    {"describe", read_as<DescribeMessage>},
    {"get", read_as<GetMessage, get>},
    {"watch", read_as<WatchMessage, watch>},
    {"codec", read_as<CodecMessage, codec>},
    {"claim", read_as<ClaimMessage>},
    {"release", read_as<ReleaseMessage>},
};
static_assert(std::size(kTypes) == std::variant_size_v<ControlMessage>);

}  // namespace

Result<ControlMessage> parse_message(std::string_view text) {
  const json object = web::parse_client_json(text);
  if (object.is_discarded()) return wrong("the message is not JSON");
  const auto found = object.is_object() ? object.find("type") : object.end();
  if (found == object.end() || !found->is_string())
    return wrong("the message must be an object with a string 'type'");
  const auto& name = found->get_ref<const std::string&>();
  for (const MessageType& type : kTypes) {
    if (name != type.name) continue;
    Reader reader(object);
    return reader.finish(type.read(reader));
  }
  return wrong("the message has an unknown type");
}

bool is_about_data(const ControlMessage& message) {
  return std::visit(
      []<class T>(const T&) {
        return std::is_same_v<T, DescribeMessage> || std::is_same_v<T, GetMessage> ||
               std::is_same_v<T, WatchMessage> || std::is_same_v<T, CopyStateMessage>;
      },
      message);
}

bool is_for_watchers(const ControlMessage& message) {
  return is_about_data(message) || std::holds_alternative<PickMessage>(message);
}

}  // namespace gloam::studio
