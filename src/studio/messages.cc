#include "studio/messages.h"

#include <cmath>
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
    ++read_;
    const auto found = object_.find(key);
    if (found == object_.end() || !found->is_number()) return fail(key, "must be a number");
    const double value = found->get<double>();
    if (!std::isfinite(value) || value < low || value > high) return fail(key, "is out of range");
    return value;
  }
  int integer(const char* key, int low, int high) {
    const double value = number(key, low, high);
    if (value != std::floor(value)) fail(key, "must be an integer");
    return static_cast<int>(value);
  }
  std::string text(const char* key, size_t max_size) {
    ++read_;
    const auto found = object_.find(key);
    if (found == object_.end() || !found->is_string()) {
      fail(key, "must be a string");
      return {};
    }
    auto value = found->get<std::string>();
    if (value.size() > max_size) fail(key, "is too long");
    return value;
  }

  Result<ControlMessage> finish(ControlMessage message) const {
    if (!problem_.empty()) return wrong(problem_);
    if (object_.size() != read_ + 1)
      return wrong("the message has a key that is unknown for its type");
    return message;
  }

 private:
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
constexpr size_t kMaxName = 1024;

template <class Message>
Message read_point(Reader& reader) {
  Message message;
  message.u = reader.number("u", -kMaxPixel, kMaxPixel);
  message.v = reader.number("v", -kMaxPixel, kMaxPixel);
  return message;
}

template <class Message>
Message read_travel(Reader& reader) {
  Message message;
  message.dx = reader.number("dx", -kMaxTravel, kMaxTravel);
  message.dy = reader.number("dy", -kMaxTravel, kMaxTravel);
  return message;
}

/// Names come from people's models and need not be UTF-8.
std::string to_text(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

Result<ControlMessage> parse_message(std::string_view text) {
  const json object = web::parse_client_json(text);
  if (object.is_discarded()) return wrong("the message is not JSON");
  const auto found = object.is_object() ? object.find("type") : object.end();
  if (found == object.end() || !found->is_string())
    return wrong("the message must be an object with a string 'type'");

  Reader reader(object);
  const auto& type = found->get_ref<const std::string&>();
  if (type == "seen") return reader.finish(SeenMessage{});
  if (type == "orbit") return reader.finish(read_travel<OrbitMessage>(reader));
  if (type == "pan") return reader.finish(read_travel<PanMessage>(reader));
  if (type == "zoom") return reader.finish(ZoomMessage{reader.number("amount", -10, 10)});
  if (type == "drag_move") return reader.finish(read_point<DragMoveMessage>(reader));
  if (type == "drag_start") return reader.finish(read_point<DragStartMessage>(reader));
  if (type == "drag_end") return reader.finish(DragEndMessage{});
  if (type == "pick") return reader.finish(read_point<PickMessage>(reader));
  if (type == "pause") return reader.finish(PauseMessage{});
  if (type == "resume") return reader.finish(ResumeMessage{});
  if (type == "step") return reader.finish(StepMessage{reader.integer("count", 1, kMaxStepCount)});
  if (type == "speed")
    return reader.finish(SpeedMessage{reader.number("value", kMinSpeed, kMaxSpeed)});
  if (type == "reset") return reader.finish(ResetMessage{});
  if (type == "seek") return reader.finish(SeekMessage{reader.number("time", 0, kMaxTime)});
  if (type == "camera") return reader.finish(CameraMessage{reader.text("name", kMaxName)});
  if (type == "claim") return reader.finish(ClaimMessage{});
  if (type == "release") return reader.finish(ReleaseMessage{});
  return wrong("the message has an unknown type");
}

std::string hello_message(int64_t client, const std::vector<std::string>& cameras, double step_rate,
                          double log_end) {
  return to_text({{"type", "hello"},
                  {"client", client},
                  {"cameras", cameras},
                  {"step_rate", step_rate},
                  {"log_end", log_end}});
}

std::string state_message(const ViewState& state) {
  // Numbers of 64 bits do not survive JavaScript, so the hash is text.
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(state.hash));
  return to_text({{"type", "state"},
                  {"step", state.step},
                  {"time", state.time},
                  {"hash", hash},
                  {"realtime_factor", state.realtime_factor},
                  {"paused", state.paused},
                  {"speed", state.speed},
                  {"camera", state.camera},
                  {"dropped", state.dropped},
                  {"warnings", state.warnings},
                  {"error", state.error},
                  {"clients", state.clients},
                  {"controller", state.controller}});
}

std::string picked_message(std::string_view body, const Vec3& point_W, bool dragging) {
  return to_text({{"type", "picked"},
                  {"found", true},
                  {"body", std::string(body)},
                  {"point", {point_W.x, point_W.y, point_W.z}},
                  {"dragging", dragging}});
}

std::string picked_nothing_message() {
  return to_text({{"type", "picked"}, {"found", false}, {"dragging", false}});
}

std::string pulled_message(const Vec3& point_W) {
  return to_text({{"type", "pulled"}, {"point", {point_W.x, point_W.y, point_W.z}}});
}

std::string notice_message(std::string_view text) {
  return to_text({{"type", "notice"}, {"text", std::string(text)}});
}

}  // namespace gloam::studio
