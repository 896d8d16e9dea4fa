#include "studio/state_key.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <pugixml.hpp>

namespace gloam::studio {
namespace {

struct KeyList {
  const char* name;
  std::vector<double> StateKey::* values;
  const char* field;     // of mjData
  const char* keyframe;  // of mjModel
};
constexpr KeyList kLists[] = {
    {"qpos", &StateKey::qpos, "qpos", "key_qpos"},
    {"qvel", &StateKey::qvel, "qvel", "key_qvel"},
    {"ctrl", &StateKey::ctrl, "ctrl", "key_ctrl"},
    {"mpos", &StateKey::mpos, "mocap_pos", "key_mpos"},
    {"mquat", &StateKey::mquat, "mocap_quat", "key_mquat"},
};

Error bad_key(std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), {}, std::move(hint)};
}

/// A field that every model has.
std::vector<double> field(const Instant& instant, const char* name) {
  auto values = instant.value(name);
  return values.ok() ? std::move(values).value() : std::vector<double>{};
}

Result<std::vector<double>> parse_numbers(const char* list, std::string_view text) {
  std::vector<double> numbers;
  constexpr std::string_view kSpace = " \t\r\n";
  for (size_t at = text.find_first_not_of(kSpace); at != std::string_view::npos;
       at = text.find_first_not_of(kSpace, at)) {
    const size_t end = std::min(text.find_first_of(kSpace, at), text.size());
    double value = 0;
    const auto [stop, code] = std::from_chars(text.data() + at, text.data() + end, value);
    if (code != std::errc() || stop != text.data() + end)
      return bad_key(fmt::format("'{}' of the key has '{:.40}', which is no number", list,
                                 text.substr(at, end - at)));
    numbers.push_back(value);
    at = end;
  }
  return numbers;
}

std::vector<double> part(const std::vector<double>& values, size_t first, size_t count) {
  if (values.empty()) return {};
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

size_t width_of(double joint_type, bool velocity) {
  constexpr size_t kPositions[] = {7, 4, 1, 1}, kVelocities[] = {6, 3, 1, 1};  // mjtJoint
  const auto type = static_cast<size_t>(joint_type);
  return velocity ? kVelocities[type] : kPositions[type];
}

}  // namespace

StateKey key_of(const Instant& instant) {
  StateKey key;
  for (const KeyList& list : kLists) key.*list.values = field(instant, list.field);
  return key;
}

Result<StateKey> keyframe_of(const Instant& instant, int keyframe) {
  const auto count = static_cast<int>(field(instant, "key_time").size());
  if (keyframe < 0 || keyframe >= count)
    return bad_key(
        fmt::format("The model has {} keyframes, so none with index {}.", count, keyframe));
  StateKey key;
  for (const KeyList& list : kLists) {
    const std::vector<double> all = field(instant, list.keyframe);
    const size_t size = all.size() / static_cast<size_t>(count);
    key.*list.values = part(all, size * static_cast<size_t>(keyframe), size);
  }
  return key;
}

std::string to_mjcf(const StateKey& key) {
  std::string text = "<key";
  for (const KeyList& list : kLists)
    if (const auto& values = key.*list.values; !values.empty())
      text += fmt::format(" {}=\"{}\"", list.name, fmt::join(values, " "));
  return text + "/>";
}

Result<StateKey> parse_key(std::string_view text) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
  if (!parsed)
    return bad_key(fmt::format("the text is no <key> element: {}", parsed.description()));
  const pugi::xml_node node = document.child("key");
  if (!node)
    return bad_key("the text is no <key> element",
                   "copy a state here, or a key of a model's <keyframe>");
  StateKey key;
  for (const KeyList& list : kLists) {
    GLOAM_TRY(key.*list.values, parse_numbers(list.name, node.attribute(list.name).value()));
  }
  return key;
}

Result<std::vector<Command>> set_key(const StateKey& key, const Instant& instant) {
  for (const KeyList& list : kLists) {
    const size_t wanted = field(instant, list.field).size(), given = (key.*list.values).size();
    if (given != 0 && given != wanted)
      return bad_key(fmt::format("'{}' of the key has {} numbers; this model has {}", list.name,
                                 given, wanted));
  }
  std::vector<Command> commands;
  const std::vector<double> types = field(instant, "jnt_type");
  size_t q = 0, v = 0;
  for (size_t i = 0; i < types.size() && !(key.qpos.empty() && key.qvel.empty()); ++i) {
    const size_t nq = width_of(types[i], false), nv = width_of(types[i], true);
    commands.push_back(
        {.what = SetJointState{
             {static_cast<int>(i), 0}, part(key.qpos, q, nq), part(key.qvel, v, nv)}});
    q += nq, v += nv;
  }
  const std::vector<double> controls = field(instant, "actuator_ctrladr");
  for (size_t i = 0; i < controls.size() && !key.ctrl.empty(); ++i)
    commands.push_back(
        {.what = SetControl{{static_cast<int>(i), 0}, key.ctrl[static_cast<size_t>(controls[i])]}});
  const std::vector<double> mocap = field(instant, "body_mocapid");
  for (size_t body = 0; body < mocap.size() && !key.mpos.empty() && !key.mquat.empty(); ++body) {
    if (mocap[body] < 0) continue;
    const auto id = static_cast<size_t>(mocap[body]);
    const std::vector<double> p = part(key.mpos, 3 * id, 3), r = part(key.mquat, 4 * id, 4);
    commands.push_back({.what = SetMocapPose{{static_cast<int>(body), 0},
                                             {{p[0], p[1], p[2]}, {r[0], r[1], r[2], r[3]}}}});
  }
  return commands;
}

}  // namespace gloam::studio
