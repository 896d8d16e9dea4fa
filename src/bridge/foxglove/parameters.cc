#include "bridge/foxglove/parameters.h"

#include <cmath>

namespace gloam::bridge::foxglove {
namespace {

using nlohmann::json;

Error bad_value(const std::string& what) { return {ErrorKind::kInput, what}; }

constexpr LiveFieldId kFieldParameters[] = {
    LiveFieldId::kGravity,      LiveFieldId::kWind,         LiveFieldId::kBodyMass,
    LiveFieldId::kGeomFriction, LiveFieldId::kLightDiffuse, LiveFieldId::kLightIntensity,
    LiveFieldId::kLightActive};
constexpr size_t kMostNumbers = 300;  // longer fields are no parameters: nobody edits them by hand

}  // namespace

Parameters::Parameters(Operator& operations, Counters& counters)
    : operations_(operations), counters_(counters) {
  Simulation& simulation = operations.simulation();
  parameters_["paused"] = {"", [&simulation] { return json(simulation.paused()); },
                           [&operations](const json& value) -> Status {
                             if (!value.is_boolean()) return bad_value("must be true or false");
                             return value.get<bool>() ? operations.pause() : operations.play();
                           }};
  parameters_["speed"] = {"float64", [&operations] { return json(operations.speed().value_or(0)); },
                          [&operations](const json& value) -> Status {
                            if (!value.is_number()) return bad_value("must be a number");
                            return operations.set_speed(value.get<double>());
                          }};
  parameters_["pace"] = {"", [&operations] { return json(to_string(operations.pace())); },
                         [&operations](const json& value) -> Status {
                           if (!value.is_string()) return bad_value("must be a string");
                           return operations.set_pace(value.get<std::string>());
                         }};
  parameters_["scene"] = {
      "", [&simulation] { return json(simulation.world().scene().file.filename().string()); }, {}};
  parameters_["step_rate"] = {
      "float64", [&simulation] { return json(simulation.step_rate().value()); }, {}};
  add_live_fields();
}

std::vector<double> Parameters::field(const std::string& model_field) {
  const Snapshot now = operations_.simulation().latest();
  if (!now) return {};
  if (!solved_ || &solved_.data() != &now.data()) {
    solved_ = {};
    if (!instant_.solve(now).ok()) return {};
    solved_ = now;
  }
  const auto values = instant_.value(model_field);
  return values.ok() ? *values : std::vector<double>();
}

void Parameters::add_live_fields() {
  Simulation& simulation = operations_.simulation();
  for (const LiveFieldId id : kFieldParameters) {
    const size_t count = field(live_field_array(id)).size();
    if (count == 0 || count > kMostNumbers) continue;
    const auto get = [this, id] { return json(field(live_field_array(id))); };
    const auto set = [this, &simulation, id](const json& value) -> Status {
      const size_t size = field(live_field_array(id)).size();
      const std::string what = "must be an array of " + std::to_string(size) + " numbers";
      if (!value.is_array() || value.size() != size) return bad_value(what);
      SetLiveField command{.field = id};
      for (const json& number : value) {
        if (!number.is_number() || !std::isfinite(number.get<double>())) return bad_value(what);
        command.values.push_back(number.get<double>());
      }
      return simulation.post(Command{.what = std::move(command)});
    };
    parameters_[live_field_name(id)] = {"float64_array", get, set};
  }
}

json Parameters::value_of(const std::string& name) const {
  const Parameter& parameter = parameters_.at(name);
  json item = {{"name", name}, {"value", parameter.get()}};
  if (!parameter.type.empty()) item["type"] = parameter.type;
  return item;
}

std::vector<std::string> Parameters::known(const ClientPtr& client,
                                           const std::vector<std::string>& names) {
  std::vector<std::string> known;
  if (names.empty())
    for (const auto& [name, parameter] : parameters_) known.push_back(name);
  for (const std::string& name : names) {
    if (parameters_.contains(name))
      known.push_back(name);
    else
      refuse_request(client, counters_, "there is no parameter '" + name + "'");
  }
  return known;
}

void Parameters::get(const ClientPtr& client, const GetParametersMessage& message) {
  json values = json::array();
  for (const std::string& name : known(client, message.names)) values.push_back(value_of(name));
  client->outbox.send(parameter_values(std::move(values), message.request));
}

Status Parameters::set_one(const SetParametersMessage::Parameter& parameter) const {
  const auto found = parameters_.find(parameter.name);
  if (found == parameters_.end()) return bad_value("is not a parameter");
  if (!found->second.set) return bad_value("is read-only");
  return found->second.set(parameter.value);
}

void Parameters::set(const ClientPtr& client, const SetParametersMessage& message) {
  json values = json::array();
  for (const SetParametersMessage::Parameter& parameter : message.parameters) {
    const Status status = set_one(parameter);
    if (status.ok())
      ++counters_.in;
    else
      refuse_request(client, counters_, "'" + parameter.name + "' " + status.error().to_string());
    if (!parameters_.contains(parameter.name)) continue;
    json item = value_of(parameter.name);
    // A Command applies at the next step: until then the requested value is reported.
    if (status.ok()) item["value"] = parameter.value;
    values.push_back(std::move(item));
  }
  client->outbox.send(parameter_values(std::move(values), message.request));
}

void Parameters::watch(const ClientPtr& client, const WatchParametersMessage& message) {
  Watcher& watcher = watchers_[client->id];
  watcher.client = client;
  json values = json::array();
  for (const std::string& name : known(client, message.names)) {
    if (!message.on)
      watcher.names.erase(name);
    else if (watcher.names.insert(name).second)
      values.push_back(told_[name] = value_of(name));
  }
  if (watcher.names.empty()) watchers_.erase(client->id);
  if (!values.empty()) client->outbox.send(parameter_values(std::move(values), ""));
}

void Parameters::tell_changes() {
  std::set<std::string> watched;
  for (const auto& [id, watcher] : watchers_)
    watched.insert(watcher.names.begin(), watcher.names.end());
  std::set<std::string> changed;
  for (const std::string& name : watched) {
    json now = value_of(name);
    json& before = told_[name];
    if (now == before) continue;
    before = std::move(now);
    changed.insert(name);
  }
  if (changed.empty()) return;
  for (const auto& [id, watcher] : watchers_) {
    json values = json::array();
    for (const std::string& name : changed)
      if (watcher.names.contains(name)) values.push_back(told_[name]);
    if (!values.empty()) watcher.client->outbox.send(parameter_values(std::move(values), ""));
  }
}

}  // namespace gloam::bridge::foxglove
