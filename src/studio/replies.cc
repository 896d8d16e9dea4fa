#include "studio/replies.h"

#include <nlohmann/json.hpp>
#include <set>
#include <utility>

namespace gloam::studio {
namespace {

using nlohmann::json;

/// Names come from people's models and need not be UTF-8.
std::string to_text(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

/// Robots, and whether their controllers accept velocity goals.
json robots_of(const World& world) {
  std::set<std::string> driven;
  for (const InputInfo& input : world.inputs())
    if (input.kind == InputKind::kVelocity) driven.insert(input.name);
  json robots = json::array();
  for (const RobotInfo& robot : world.robots())
    robots.push_back({{"name", robot.name}, {"drives", driven.contains(robot.name)}});
  return robots;
}

}  // namespace

std::string hello_message(const Greeting& greeting) {
  return to_text({{"type", "hello"},
                  {"version", 2},
                  {"client", greeting.client},
                  {"title", greeting.title},
                  {"cameras", greeting.cameras},
                  {"step_rate", greeting.step_rate},
                  {"log_end", greeting.log_end}});
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
                  {"controller", state.controller},
                  {"history_start", state.history_start},
                  {"run", state.run},
                  {"serial", state.serial}});
}

std::string model_message(const World& world) {
  if (world.compiled() == nullptr) return to_text({{"type", "model"}, {"serial", 0}});
  constexpr std::pair<const char*, const char*> kLists[] = {
      {"bodies", "body"},         {"joints", "joint"},   {"geoms", "geom"},
      {"sites", "site"},          {"lights", "light"},   {"meshes", "mesh"},
      {"actuators", "actuator"},  {"sensors", "sensor"}, {"tendons", "tendon"},
      {"equalities", "equality"}, {"keyframes", "key"}};
  json message = {{"type", "model"}, {"serial", world.serial()}, {"robots", robots_of(world)}};
  for (const auto& [list, type] : kLists) message[list] = *world.names(type);
  return to_text(message);
}

std::string picked_message(Body body, std::string_view name, const Vec3& point_W, bool dragging) {
  return to_text({{"type", "picked"},
                  {"found", true},
                  {"body", name},
                  {"id", body.id},
                  {"point", {point_W.x, point_W.y, point_W.z}},
                  {"dragging", dragging}});
}

std::string picked_nothing_message() { return to_text({{"type", "picked"}, {"found", false}}); }

std::string pulled_message(const Vec3& point_W) {
  return to_text({{"type", "pulled"}, {"point", {point_W.x, point_W.y, point_W.z}}});
}

std::string copied_message(std::string_view key) {
  return to_text({{"type", "copied"}, {"text", key}});
}

std::string notice_message(std::string_view text) {
  return to_text({{"type", "notice"}, {"text", text}});
}

}  // namespace gloam::studio
