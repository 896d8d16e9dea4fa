#pragma once
// Parameters: what of a running simulation clients may read and change.

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "bridge/foxglove/client_messages.h"
#include "bridge/foxglove/counters.h"
#include "bridge/operations/operator.h"

namespace gloam::bridge::foxglove {

/// One thread's alone: a value may be asked of the simulation.
class Parameters {
 public:
  Parameters(Operator& operations, Counters& counters);

  void get(const ClientPtr& client, const GetParametersMessage& message);
  void set(const ClientPtr& client, const SetParametersMessage& message);
  void watch(const ClientPtr& client, const WatchParametersMessage& message);
  void leave(const ClientPtr& client) { watchers_.erase(client->id); }
  /// Tells watchers what has changed since the last call.
  void tell_changes();

 private:
  struct Parameter {
    std::string type;  ///< "float64", "float64_array" or ""
    std::function<nlohmann::json()> get;
    std::function<Status(const nlohmann::json&)> set;  ///< null: it can only be read
  };
  struct Watcher {
    ClientPtr client;
    std::set<std::string> names;
  };
  void add_live_fields();
  /// Numbers of a field of mjModel at the latest instant; none where there are none.
  std::vector<double> field(const std::string& model_field);
  nlohmann::json value_of(const std::string& name) const;
  /// Names that there are; tells the client of others.
  std::vector<std::string> known(const ClientPtr& client, const std::vector<std::string>& names);
  Status set_one(const SetParametersMessage::Parameter& parameter) const;

  Operator& operations_;
  Counters& counters_;
  Instant instant_;
  Snapshot solved_;  // instant_ is of it
  std::map<std::string, Parameter> parameters_;
  std::map<int64_t, Watcher> watchers_;
  std::map<std::string, nlohmann::json> told_;
};

}  // namespace gloam::bridge::foxglove
