#pragma once
// Graph: which topics and services there are, and who gives and takes them.

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "bridge/foxglove/channels.h"
#include "bridge/foxglove/publishing.h"
#include "bridge/foxglove/services.h"

namespace gloam::bridge::foxglove {

class Graph {
 public:
  Graph(Simulation& simulation, const Channels& channels, const Publishing& publishing,
        const Services& services)
      : simulation_(simulation),
        channels_(channels),
        publishing_(publishing),
        services_(services) {}

  /// Somebody has come or gone. Any thread.
  void note_change() { changed_ = true; }

  // The network's thread.
  /// Tells a client of the graph, now and whenever it changes; with `on` false no more.
  void watch(const ClientPtr& client, bool on);
  void leave(const ClientPtr& client) { watchers_.erase(client->id); }
  void tell_changes();

 private:
  nlohmann::json now() const;

  Simulation& simulation_;
  const Channels& channels_;
  const Publishing& publishing_;
  const Services& services_;
  std::atomic<bool> changed_{false};
  std::map<int64_t, ClientPtr> watchers_;
  std::set<std::string> told_topics_;
};

}  // namespace gloam::bridge::foxglove
