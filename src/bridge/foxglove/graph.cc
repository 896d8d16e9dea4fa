#include "bridge/foxglove/graph.h"

#include <utility>

namespace gloam::bridge::foxglove {

using nlohmann::json;

json Graph::now() const {
  const auto peers = [](const std::vector<int64_t>& clients) {
    json names = json::array();
    for (const int64_t client : clients) names.push_back("client " + std::to_string(client));
    return names;
  };
  json published = json::array(), subscribed = json::array(), services = json::array();
  for (const ChannelInfo& channel : channels_.list())
    published.push_back({{"name", channel.topic}, {"publisherIds", {"gloam"}}});
  for (const auto& [topic, clients] : publishing_.publishers()) {
    published.push_back({{"name", topic}, {"publisherIds", peers(clients)}});
  }
  for (const auto& [topic, clients] : channels_.subscribers())
    subscribed.push_back({{"name", topic}, {"subscriberIds", peers(clients)}});
  if (const auto topics = simulation_.topics(); topics.ok())
    for (const TopicInfo& topic : *topics)
      if (topic.is_input)
        subscribed.push_back({{"name", topic.name}, {"subscriberIds", {"gloam"}}});
  for (const ServiceInfo& service : services_.list())
    services.push_back({{"name", service.name}, {"providerIds", {"gloam"}}});
  return {{"publishedTopics", std::move(published)},
          {"subscribedTopics", std::move(subscribed)},
          {"advertisedServices", std::move(services)},
          {"removedTopics", json::array()},
          {"removedServices", json::array()}};
}

void Graph::watch(const ClientPtr& client, bool on) {
  if (!on) return leave(client);
  watchers_[client->id] = client;
  client->outbox.send(connection_graph(now()));
}

void Graph::tell_changes() {
  if (watchers_.empty() || !changed_.exchange(false)) return;
  json graph = now();
  std::set<std::string> names;
  for (const char* list : {"publishedTopics", "subscribedTopics"})
    for (const json& topic : graph[list]) names.insert(topic["name"]);
  for (const std::string& name : told_topics_)
    if (!names.contains(name)) graph["removedTopics"].push_back(name);
  told_topics_ = std::move(names);
  for (const auto& [id, client] : watchers_) client->outbox.send(connection_graph(graph));
}

}  // namespace gloam::bridge::foxglove
