#include "bridge/ros2/dds_node.h"

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/flowcontrol/FlowControllerDescriptor.hpp>

#include <algorithm>
#include <map>
#include <set>

#include "bridge/ros2/dds_endpoints.h"
#include "bridge/ros2/loopback_transport.h"
#include "bridge/ros2/raw_type.h"
#include "ros/codec.h"
#include "ros/messages/rmw_dds_common.h"

namespace gloam::bridge {
namespace {

constexpr int32_t kBytesPerPeriod = 132'000;  // two of DDS's fragments, which are of 65,500 bytes
constexpr uint64_t kPeriod = 2;               // [ms]
constexpr int kLocalParticipants = 32;        // of one domain that are looked for on loopback

// Ports of RTPS 2.5, 9.6.2.3.
uint32_t discovery_port(int domain) { return static_cast<uint32_t>(7400 + 250 * domain); }
uint32_t unicast_port(int domain, int participant) {
  return discovery_port(domain) + 10 + 2 * static_cast<uint32_t>(participant);
}

rtps::Locator_t udp_locator(const char* address, uint32_t port) {
  rtps::Locator_t locator;
  locator.kind = LOCATOR_KIND_UDPv4;
  rtps::IPLocator::setIPv4(locator, address);
  locator.port = port;
  return locator;
}

dds::DomainParticipantQos participant_qos(const DdsNodeOptions& options) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  qos.name(options.node.c_str());
  const std::string enclave = "enclave=/;";
  qos.user_data().setValue({enclave.begin(), enclave.end()});
  qos.transport().use_builtin_transports = false;
  // No shared memory: of Fast DDS 2.9 a reader that is killed leaves its port locked for all, and
  // Fast DDS 3 does not know 2.9's names.
  if (options.network)
    qos.transport().user_transports = {std::make_shared<NetworkTransportDescriptor>()};
  else
    qos.transport().user_transports = {std::make_shared<LoopbackTransportDescriptor>()};
  // A picture sent at once would overflow its reader's socket, which holds 212,992 bytes by
  // default.
  const auto pace = std::make_shared<transport::FlowControllerDescriptor>();
  pace->name = kLargeMessageFlow;
  pace->scheduler = transport::FlowControllerSchedulerPolicy::FIFO;
  pace->max_bytes_per_period = kBytesPerPeriod;
  pace->period_ms = kPeriod;
  if (kUsesFlowController) qos.flow_controllers().push_back(pace);
  // Who is on this machine is asked one by one: multicast may not pass loopback.
  auto& peers = qos.wire_protocol().builtin.initialPeersList;
  peers.push_back(udp_locator("239.255.0.1", discovery_port(options.domain)));
  for (int i = 0; i < kLocalParticipants; ++i)
    peers.push_back(udp_locator("127.0.0.1", unicast_port(options.domain, i)));
  return qos;
}

// stdout is the program's data.
void log_to_stderr() {
  static std::once_flag once;
  std::call_once(once, [] {
    dds::Log::ClearConsumers();
    auto consumer = std::make_unique<dds::StdoutErrConsumer>();
    consumer->stderr_threshold(dds::Log::Kind::Info);
    dds::Log::RegisterConsumer(std::move(consumer));
    dds::Log::SetVerbosity(dds::Log::Kind::Error);
  });
}

rmw_dds_common::Gid gid_of(const rtps::GUID_t& guid) {
  rmw_dds_common::Gid gid;
  std::copy_n(guid.guidPrefix.value, 12, gid.data.begin());
  std::copy_n(guid.entityId.value, 4, gid.data.begin() + 12);
  return gid;
}

}  // namespace

class DdsNode::Impl {
 public:
  explicit Impl(const DdsNodeOptions& options) : options_(options) {}
  ~Impl() {
    if (participant_ == nullptr) return;
    discovery_.reset();
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  Status open() {
    log_to_stderr();
    participant_ = dds::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<uint32_t>(options_.domain), participant_qos(options_));
    if (participant_ == nullptr)
      return Error{ErrorKind::kIo,
                   "cannot create a DDS participant in domain " + std::to_string(options_.domain),
                   {},
                   "there may be over 100 programs in this domain; select another one with "
                   "bridge.ros2.domain or ROS_DOMAIN_ID"};
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    if (publisher_ == nullptr || subscriber_ == nullptr)
      return Error{ErrorKind::kIo, "DDS cannot create a publisher or subscriber"};
    return {};
  }

  Result<dds::Topic*> topic(const DdsEndpoint& endpoint) {
    const std::lock_guard lock(mutex_);
    if (!types_.contains(endpoint.type)) {
      dds::TypeSupport type(new RawType(endpoint.type));
      if (!succeeded(type.register_type(participant_)))
        return Error{ErrorKind::kIo, "DDS rejected type " + endpoint.type};
      types_.emplace(endpoint.type, type);
    }
    dds::Topic*& topic = topics_[endpoint.topic];
    if (topic == nullptr)
      topic = participant_->create_topic(endpoint.topic, endpoint.type, dds::TOPIC_QOS_DEFAULT);
    else if (topic->get_type_name() != endpoint.type)
      return Error{ErrorKind::kUsage, "topic " + endpoint.topic + " has two types"};
    if (topic == nullptr) return Error{ErrorKind::kIo, "DDS rejected topic " + endpoint.topic};
    return topic;
  }

  EndpointEvent on_begin(bool is_writer) {
    return [this, &list = is_writer ? writers_ : readers_](const rtps::GUID_t& guid) {
      const std::lock_guard lock(mutex_);
      list.insert(guid);
    };
  }
  EndpointEvent on_end() {
    return [this](const rtps::GUID_t& guid) {
      const std::lock_guard lock(mutex_);
      writers_.erase(guid);
      readers_.erase(guid);
    };
  }
  std::vector<uint8_t> entities() {
    const std::lock_guard lock(mutex_);
    rmw_dds_common::NodeEntitiesInfo node;
    node.node_namespace = options_.ns;
    node.node_name = options_.node;
    for (const auto& guid : readers_) node.reader_gid_seq.push_back(gid_of(guid));
    for (const auto& guid : writers_) node.writer_gid_seq.push_back(gid_of(guid));
    rmw_dds_common::ParticipantEntitiesInfo info;
    info.gid = gid_of(participant_->guid());
    info.node_entities_info_seq.push_back(std::move(node));
    std::vector<uint8_t> bytes;
    encode(info, &bytes);
    return bytes;
  }

  dds::Publisher& publisher() { return *publisher_; }
  dds::Subscriber& subscriber() { return *subscriber_; }
  std::unique_ptr<DdsWriter> discovery_;  // of ros_discovery_info

 private:
  const DdsNodeOptions options_;
  dds::DomainParticipant* participant_ = nullptr;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  std::mutex mutex_;
  std::map<std::string, dds::TypeSupport> types_;
  std::map<std::string, dds::Topic*> topics_;
  std::set<rtps::GUID_t> writers_, readers_;
};

Result<std::unique_ptr<DdsNode>> DdsNode::create(const DdsNodeOptions& options) {
  auto impl = std::make_shared<Impl>(options);
  GLOAM_TRY_STATUS(impl->open());
  std::unique_ptr<DdsNode> node(new DdsNode(impl));
  GLOAM_TRY(impl->discovery_,
            node->add_writer({.topic = "ros_discovery_info",
                              .type = "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                              .qos = {.is_reliable = true, .is_latched = true, .depth = 1}}));
  return node;
}

DdsNode::~DdsNode() = default;

Result<std::unique_ptr<DdsWriter>> DdsNode::add_writer(const DdsEndpoint& endpoint,
                                                       std::function<void()> on_match) {
  GLOAM_TRY(dds::Topic * topic, impl_->topic(endpoint));
  return open_writer(impl_->publisher(), *topic, endpoint,
                     {impl_->on_begin(true), impl_->on_end(), std::move(on_match)});
}

Result<std::unique_ptr<DdsReader>> DdsNode::add_reader(
    const DdsEndpoint& endpoint, std::function<void(const DdsSample&)> on_sample) {
  GLOAM_TRY(dds::Topic * topic, impl_->topic(endpoint));
  return open_reader(impl_->subscriber(), *topic, endpoint,
                     {impl_->on_begin(false), impl_->on_end(), std::move(on_sample)});
}

void DdsNode::announce() { static_cast<void>(impl_->discovery_->write(impl_->entities())); }

}  // namespace gloam::bridge
