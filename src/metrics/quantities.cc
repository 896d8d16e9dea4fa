#include "metrics/quantities.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "metrics/element_fields.h"
#include "metrics/probe_readings.h"
#include "scene/options/probe_quantities.h"
#include "world/model_names.h"

namespace gloam {
namespace {

using Steps = std::span<const NameStep>;

Error refuse_name(const NameStep& step, std::string message, const std::string& wrong = {},
                  std::span<const std::string> known = {}) {
  std::string hint;
  if (!known.empty()) hint = suggest_name(wrong, known);
  return {ErrorKind::kInput, std::move(message), step.loc, std::move(hint)};
}

const ElementField* find_field(std::span<const ElementField> fields, const NameStep& step) {
  if (step.is_call || step.index >= 0) return nullptr;
  const auto found = std::ranges::find(fields, step.word, &ElementField::name);
  return found == fields.end() ? nullptr : &*found;
}

std::vector<std::string> field_names(std::span<const ElementField> fields) {
  std::vector<std::string> names;
  for (const ElementField& field : fields) names.emplace_back(field.name);
  return names;
}

// Names of the elements of a type that begin with a prefix, without it.
std::vector<std::string> names_below(const mjModel& m, mjtObj type, mjtSize count,
                                     const std::string& prefix) {
  std::vector<std::string> names;
  for (int id = 0; id < static_cast<int>(count); ++id) {
    const std::string name = name_of(m, type, id);
    if (!name.empty() && name.starts_with(prefix)) names.push_back(name.substr(prefix.size()));
  }
  return names;
}

}  // namespace

std::vector<std::string> Quantities::words() const {
  std::vector<std::string> words = field_names(scene_numbers());
  for (const ElementKind& kind : element_kinds()) words.emplace_back(kind.word);
  words.insert(words.end(), {"sensor", "contacts", "robot"});
  return words;
}

Result<QuantitySlot> Quantities::find(Steps name) {
  const NameStep& first = name[0];
  if (first.word == "robot") return find_robot(name);
  if (first.is_call) return find_element(name, "");
  return find_scene_number(name);
}

Result<QuantitySlot> Quantities::find_scene_number(Steps name) {
  const ElementField* field = find_field(scene_numbers(), name[0]);
  if (field != nullptr) return place({.width = field->width, .read = field->read}, name.subspan(1));
  const std::vector<std::string> known = words();
  if (std::ranges::find(known, name[0].word) != known.end())
    return Error{ErrorKind::kInput, fmt::format("'{}' needs a name", name[0].word), name[0].loc,
                 fmt::format("write {}(\"NAME\")", name[0].word)};
  return refuse_name(name[0], fmt::format("unknown quantity '{}'", name[0].word), name[0].word,
                     known);
}

Result<QuantitySlot> Quantities::find_robot(Steps name) {
  const NameStep& first = name[0];
  int robot = robot_;
  if (first.is_call) {
    if (first.arguments.size() != 1) return refuse_name(first, "'robot' takes one name");
    std::vector<std::string> known;
    for (const RobotInstance& other : world_.robots) known.push_back(other.name);
    const auto found = std::ranges::find(known, first.arguments[0]);
    if (found == known.end())
      return refuse_name(first, fmt::format("there is no robot '{}'", first.arguments[0]),
                         first.arguments[0], known);
    robot = static_cast<int>(found - known.begin());
  }
  if (robot < 0)
    return Error{ErrorKind::kInput, "the metric has no robot", first.loc,
                 "set 'robots', or write robot(\"NAME\")"};
  if (name.size() < 2)
    return Error{ErrorKind::kInput, "'robot' is not a number", first.loc,
                 "write robot.position, robot.speed …"};
  const Steps rest = name.subspan(1);
  if (rest[0].is_call) return find_element(rest, world_.robots[static_cast<size_t>(robot)].prefix);
  return find_robot_number(robot, rest);
}

Result<QuantitySlot> Quantities::find_robot_number(int robot, Steps rest) {
  const int root = world_.robots[static_cast<size_t>(robot)].root_body;
  const ElementField* field = find_field(body_fields(), rest[0]);
  if (field != nullptr && root > 0)
    return place({.id = root, .width = field->width, .read = field->read}, rest.subspan(1));
  std::vector<std::string> known = field_names(body_fields());
  for (const BuiltinColumn& column : builtin_) {
    if (column.robot != robot) continue;
    known.push_back(column.name);
    if (column.name != rest[0].word || rest[0].index >= 0) continue;
    return place({.id = column.column,
                  .read = [](const MetricInstant& in, const QuantityReader& r,
                             double* out) { *out = in.row[static_cast<size_t>(r.id)]; }},
                 rest.subspan(1));
  }
  return refuse_name(rest[0], fmt::format("this robot has no '{}'", rest[0].word), rest[0].word,
                     known);
}

Result<QuantitySlot> Quantities::find_element(Steps name, const std::string& prefix) {
  const NameStep& first = name[0];
  if (first.word == "contacts") return find_contacts(name, prefix);
  const bool is_sensor = first.word == "sensor";
  const auto kind = std::ranges::find(element_kinds(), first.word, &ElementKind::word);
  if (kind == element_kinds().end() && !is_sensor)
    return refuse_name(first, fmt::format("unknown quantity '{}(…)'", first.word), first.word,
                       words());
  if (first.arguments.size() != 1)
    return refuse_name(first, fmt::format("'{}' takes one name in quotes", first.word));
  const mjModel& m = *world_.model;
  const mjtObj type = is_sensor ? mjOBJ_SENSOR : kind->type;
  const std::string& wanted = first.arguments[0];
  const int id = mj_name2id(&m, type, (prefix + wanted).c_str());
  if (id < 0) {
    std::vector<std::string> known =
        names_below(m, type, is_sensor ? m.nsensor : m.*kind->count, prefix);
    for (size_t i = 0; is_sensor && prefix.empty() && i < world_.probes.size(); ++i) {
      if (world_.probes[i].options.name == wanted) return find_probe(name, static_cast<int>(i));
      known.push_back(world_.probes[i].options.name);
    }
    return refuse_name(first, fmt::format("there is no {} '{}'", first.word, prefix + wanted),
                       wanted, known);
  }
  if (is_sensor) return find_sensor(name, id);
  if (name.size() < 2 || first.index >= 0)
    return Error{ErrorKind::kInput, fmt::format("{} '{}' needs a field", first.word, wanted),
                 first.loc, fmt::format("append .{}", kind->fields.front().name)};
  const ElementField* field = find_field(kind->fields, name[1]);
  if (field == nullptr)
    return refuse_name(name[1], fmt::format("a {} has no '{}'", first.word, name[1].word),
                       name[1].word, field_names(kind->fields));
  if (type == mjOBJ_JOINT && m.jnt_type[id] != mjJNT_HINGE && m.jnt_type[id] != mjJNT_SLIDE)
    return Error{ErrorKind::kInput,
                 fmt::format("joint '{}' is neither a hinge nor a slide", prefix + wanted),
                 first.loc, "use its body: body(\"NAME\").velocity"};
  return place({.id = id, .width = field->width, .read = field->read}, name.subspan(2));
}

Result<QuantitySlot> Quantities::find_sensor(Steps name, int id) {
  const NameStep& first = name[0];
  const mjModel& m = *world_.model;
  GLOAM_TRY(const int width, sensor_width(first, m.sensor_dim[id]));
  return place({.id = m.sensor_adr[id] + std::max(first.index, 0),
                .width = width,
                .read = [](const MetricInstant& in, const QuantityReader& r,
                           double* out) { std::copy_n(in.data->sensordata + r.id, r.width, out); }},
               name.subspan(1));
}

Result<QuantitySlot> Quantities::find_probe(Steps name, int probe) {
  const NameStep& first = name[0];
  const ProbeDescription& in = world_.probes[static_cast<size_t>(probe)];
  GLOAM_TRY(const int width, sensor_width(first, in.quantity->count()));
  return place({.id = std::max(first.index, 0),
                .probe = probe,
                .width = width,
                .read =
                    [](const MetricInstant& instant, const QuantityReader& r, double* out) {
                      std::copy_n(instant.probes->numbers(r.probe).data() + r.id, r.width, out);
                    }},
               name.subspan(1));
}

// Numbers that are read of a sensor with `count` of them.
Result<int> Quantities::sensor_width(const NameStep& step, int count) const {
  if (step.index >= count)
    return refuse_name(step, fmt::format("sensor '{}' has {} number{}, starting at [0]",
                                         step.arguments[0], count, count == 1 ? "" : "s"));
  if (step.index < 0 && count != 1 && count != 3)
    return Error{ErrorKind::kInput,
                 fmt::format("sensor '{}' has {} numbers", step.arguments[0], count), step.loc,
                 "append [0], [1] …"};
  return step.index < 0 ? count : 1;
}

Result<std::vector<char>> Quantities::geoms_like(const std::string& pattern,
                                                 const NameStep& step) const {
  const mjModel& m = *world_.model;
  std::vector<char> geoms(static_cast<size_t>(m.ngeom), 0);
  std::vector<std::string> known;
  bool any = false;
  for (int g = 0; g < m.ngeom; ++g) {
    const int body = m.geom_bodyid[g];
    for (const std::string& name : {name_of(m, mjOBJ_GEOM, g), name_of(m, mjOBJ_BODY, body)}) {
      if (!name.empty()) known.push_back(name);
      if (name != pattern && !fits_pattern(pattern, name)) continue;
      geoms[static_cast<size_t>(g)] = 1;
      any = true;
    }
  }
  if (any) return geoms;
  return refuse_name(step, fmt::format("there is no geom or body '{}'", pattern), pattern, known);
}

Result<QuantitySlot> Quantities::find_contacts(Steps name, const std::string& prefix) {
  const NameStep& first = name[0];
  if (first.arguments.empty() || first.arguments.size() > 2)
    return refuse_name(first, "'contacts' takes the names of one or both sides");
  QuantityReader reader;
  GLOAM_TRY(reader.a, geoms_like(prefix + first.arguments[0], first));
  reader.b.assign(reader.a.size(), 1);
  if (first.arguments.size() == 2) {
    GLOAM_TRY(reader.b, geoms_like(first.arguments[1], first));
  }
  if (name.size() < 2)
    return Error{ErrorKind::kInput, "'contacts' needs a field", first.loc,
                 "append .count, .force or .depth"};
  const ElementField* field = find_field(contact_fields(), name[1]);
  if (field == nullptr)
    return refuse_name(name[1], fmt::format("contacts have no '{}'", name[1].word), name[1].word,
                       field_names(contact_fields()));
  reader.read = field->read;
  return place(std::move(reader), name.subspan(2));
}

Result<QuantitySlot> Quantities::place(QuantityReader reader, Steps rest) {
  QuantitySlot slot{static_cast<int>(size_), reader.width};
  if (!rest.empty()) {
    const NameStep& step = rest[0];
    const size_t axis =
        step.word.size() == 1 ? std::string_view("xyz").find(step.word) : std::string_view::npos;
    if (reader.width != 3 || axis == std::string_view::npos || step.is_call || step.index >= 0)
      return Error{ErrorKind::kInput, fmt::format("unexpected '.{}'", step.word), step.loc,
                   reader.width == 3 ? "a vector has .x, .y and .z" : ""};
    if (rest.size() > 1)
      return Error{ErrorKind::kInput, fmt::format("unexpected '.{}'", rest[1].word), rest[1].loc};
    slot = {slot.first + static_cast<int>(axis), 1};
  }
  reader.first = size_;
  size_ += static_cast<size_t>(reader.width);
  readers_.push_back(std::move(reader));
  return slot;
}

}  // namespace gloam
