// The bridge to ROS 2: one node with the output and input topics of the simulation, and services.

#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>

#include "bridge/bridge_list.h"
#include "bridge/ros2/dds_node.h"
#include "bridge/ros2/node_services.h"
#include "bridge/ros2/ros2_names.h"
#include "bridge/ros2/service_server.h"
#include "bridge/ros2/topic_inlets.h"
#include "bridge/ros2/topic_outlets.h"
#include "bridge/topic_filter.h"
#include "gloam/text.h"

namespace gloam::bridge {
namespace {

constexpr auto kPollPeriod = std::chrono::milliseconds(100);  // at silent publishers of commands
constexpr int kLargestDomain = 232;

Result<int> domain_of(const Ros2Options& options) {
  if (options.domain) return *options.domain;
  const char* given = std::getenv("ROS_DOMAIN_ID");
  if (given == nullptr || *given == '\0') return 0;
  const char* const end = given + std::strlen(given);
  int domain = -1;  // strtol would take blanks and signs
  const auto [after, error] = std::from_chars(given, end, domain);
  if (error == std::errc() && after == end && domain >= 0 && domain <= kLargestDomain)
    return domain;
  return Error{ErrorKind::kUsage, std::string("ROS_DOMAIN_ID '") + given + "' must be 0 … 232"};
}

class Ros2Bridge final : public Bridge, private TopicSink {
 public:
  Ros2Bridge(const BridgeContext& context, const Ros2Options& options)
      : simulation_(context.simulation), operations_(context.operations), options_(options) {}
  ~Ros2Bridge() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
    subscription_.reset();
    if (services_ != nullptr) services_->stop();
  }

  Status open() {
    GLOAM_TRY(domain_, domain_of(options_));
    const std::string ns = options_.ns.empty() ? "/" : options_.ns;
    if (ns[0] != '/' || ros_name(ns) != ns)
      return Error{ErrorKind::kUsage, "'" + ns + "' is not a valid ROS namespace", options_.loc,
                   "use letters, digits and '_' between slashes, as in '/sim'"};
    GLOAM_TRY(node_, DdsNode::create({.domain = domain_,
                                      .network = options_.network,
                                      .node = ros_name(options_.node),
                                      .ns = ns}));
    outlets_ = std::make_unique<TopicOutlets>(*node_, [this] { look(); });
    inlets_ = std::make_unique<TopicInlets>(simulation_, *node_);
    services_ = std::make_unique<ServiceServer>(*node_);
    offers_ = std::make_unique<NodeServices>(operations_, *node_, *services_);
    GLOAM_TRY_STATUS(
        offers_->open(options_.interfaces, ns == "/" ? "" : ns, ros_name(options_.node)));
    GLOAM_TRY(subscription_, simulation_.subscribe(*this));
    GLOAM_TRY_STATUS(topics_status_);
    services_->start();
    thread_ = std::thread([this] { run(); });
    return {};
  }

  std::string name() const override { return "ros2"; }
  std::string address() const override {
    return "node '" + options_.node + "' in domain " + std::to_string(domain_) +
           (options_.network ? ", all network interfaces" : ", this machine only");
  }
  BridgeStats stats() const override {
    BridgeStats stats;
    stats.clients = outlets_->subscriptions();
    stats.messages_out = outlets_->sent() + services_->answered();
    stats.messages_in = inlets_->heard() + services_->answered();
    stats.refused = inlets_->refused() + services_->refused();
    stats.dropped = outlets_->lost() + subscription_->dropped();
    return stats;
  }
  Status status() const override { return {}; }

 private:
  void on_message(const TopicMessage& message) override { outlets_->write(message); }
  void on_topics(std::span<const TopicInfo> topics) override {
    topics_status_ = set_topics(topics);
    tell(topics_status_);
    look();
  }
  void on_error(const std::string&, const Error& why) override { tell(why); }

  // The topics of the World that runs; a recompile may change them.
  Status set_topics(std::span<const TopicInfo> topics) {
    std::vector<TopicInfo> outputs, inputs;
    for (const TopicInfo& topic : topics)
      if (is_offered(options_.topics, topic.name))
        (topic.is_input ? inputs : outputs).push_back(topic);
    GLOAM_TRY_STATUS(outlets_->set_topics(outputs));
    GLOAM_TRY_STATUS(inlets_->set_topics(inputs));
    GLOAM_TRY_STATUS(offers_->follow_robots());
    node_->announce();
    return {};
  }

  void look() {
    {
      const std::lock_guard lock(mutex_);
      is_due_ = true;
    }
    wake_.notify_all();
  }

  void tell(const Status& status) {
    if (!status.ok()) std::fprintf(stderr, "gloam: ros2: %s\n", status.error().to_string().c_str());
  }

  void run() {
    std::unique_lock lock(mutex_);
    auto told = std::chrono::steady_clock::now() - std::chrono::hours(1);
    while (!stopping_) {
      wake_.wait_for(lock, kPollPeriod, [this] { return stopping_ || is_due_; });
      if (stopping_) return;
      is_due_ = false;
      lock.unlock();
      subscription_->set_topics(outlets_->wanted());
      inlets_->release_silent();
      const auto now = std::chrono::steady_clock::now();
      if (now - told > std::chrono::seconds(1)) {
        const std::string refusal = inlets_->take_refusal();
        if (!refusal.empty()) {
          std::fprintf(stderr, "gloam: ros2: rejected: %s\n", printable(refusal).c_str());
          told = now;
        }
      }
      lock.lock();
    }
  }

  Simulation& simulation_;
  Operator& operations_;
  const Ros2Options options_;
  int domain_ = 0;
  std::unique_ptr<DdsNode> node_;
  std::unique_ptr<TopicOutlets> outlets_;
  std::unique_ptr<TopicInlets> inlets_;
  std::unique_ptr<NodeServices> offers_;
  std::unique_ptr<ServiceServer> services_;
  std::unique_ptr<TopicSubscription> subscription_;
  Status topics_status_;  // of the last on_topics()
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false, is_due_ = false;
  std::thread thread_;
};

}  // namespace

Result<std::unique_ptr<Bridge>> start_ros2(const BridgeContext& context,
                                           const Ros2Options& options) {
  auto bridge = std::make_unique<Ros2Bridge>(context, options);
  GLOAM_TRY_STATUS(bridge->open());
  return std::unique_ptr<Bridge>(std::move(bridge));
}

}  // namespace gloam::bridge
