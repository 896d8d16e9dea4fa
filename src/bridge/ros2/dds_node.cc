#include "bridge/ros2/dds_node.h"

#include <fastdds/rtps/common/WriteParams.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/log/Log.hpp>
#include <fastdds/dds/log/StdoutErrConsumer.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/flowcontrol/FlowControllerDescriptor.hpp>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <map>
#include <set>

#include "bridge/ros2/loopback_transport.h"
#include "bridge/ros2/raw_type.h"
#include "ros/codec.h"
#include "ros/messages/rmw_dds_common.h"

namespace gloam::bridge {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastrtps::types::ReturnCode_t;

constexpr const char* kPaceName = "gloam_large";
constexpr int32_t kBytesPerPeriod = 132'000;  // two of DDS's fragments, which are of 65,500 bytes
constexpr uint64_t kPeriod = 2;               // [ms]
constexpr int kLocalParticipants = 32;        // of one domain that are looked for on loopback
constexpr auto kReplyPatience = std::chrono::milliseconds(500);

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
    qos.transport().user_transports = {
        std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>()};
  else
    qos.transport().user_transports = {std::make_shared<LoopbackTransportDescriptor>()};
  // A picture sent at once would overflow its reader's socket, which holds 212,992 bytes by
  // default.
  const auto pace = std::make_shared<eprosima::fastdds::rtps::FlowControllerDescriptor>();
  pace->name = kPaceName;
  pace->scheduler = eprosima::fastdds::rtps::FlowControllerSchedulerPolicy::FIFO;
  pace->max_bytes_per_period = kBytesPerPeriod;
  pace->period_ms = kPeriod;
  qos.flow_controllers().push_back(pace);
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

template <class Qos>
void set_qos(const DdsEndpoint& endpoint, Qos* qos) {
  qos->reliability().kind =
      endpoint.qos.is_reliable ? dds::RELIABLE_RELIABILITY_QOS : dds::BEST_EFFORT_RELIABILITY_QOS;
  qos->durability().kind =
      endpoint.qos.is_latched ? dds::TRANSIENT_LOCAL_DURABILITY_QOS : dds::VOLATILE_DURABILITY_QOS;
  qos->history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos->history().depth = std::max(endpoint.qos.depth, 1);
  qos->endpoint().history_memory_policy = rtps::DYNAMIC_REUSABLE_MEMORY_MODE;
  qos->data_sharing().off();
  if (endpoint.type_hash.empty()) return;
  const std::string hash = "typehash=" + endpoint.type_hash + ";";
  qos->user_data().setValue({hash.begin(), hash.end()});
}

rmw_dds_common::Gid gid_of(const rtps::GUID_t& guid) {
  rmw_dds_common::Gid gid;
  std::copy_n(guid.guidPrefix.value, 12, gid.data.begin());
  std::copy_n(guid.entityId.value, 4, gid.data.begin() + 12);
  return gid;
}

// Whom a reply to a request is for: rmw_fastrtps gives the GUID of its client's reader beside it.
DdsRequest requester(const dds::SampleInfo& info) {
  DdsRequest request = info.sample_identity;
  const rtps::GUID_t& reader = info.related_sample_identity.writer_guid();
  if (reader != rtps::GUID_t::unknown()) request.writer_guid(reader);
  return request;
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
                   "no DDS participant in domain " + std::to_string(options_.domain),
                   {},
                   "over 100 programs in one domain? try another: bridge.ros2.domain, or "
                   "ROS_DOMAIN_ID"};
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    if (publisher_ == nullptr || subscriber_ == nullptr)
      return Error{ErrorKind::kIo, "DDS has no publisher or subscriber to give"};
    return {};
  }

  Result<dds::Topic*> topic(const DdsEndpoint& endpoint) {
    const std::lock_guard lock(mutex_);
    if (!types_.contains(endpoint.type)) {
      dds::TypeSupport type(new RawType(endpoint.type));
      if (type.register_type(participant_) != ReturnCode_t::RETCODE_OK)
        return Error{ErrorKind::kIo, "DDS refuses type " + endpoint.type};
      types_.emplace(endpoint.type, type);
    }
    dds::Topic*& topic = topics_[endpoint.topic];
    if (topic == nullptr)
      topic = participant_->create_topic(endpoint.topic, endpoint.type, dds::TOPIC_QOS_DEFAULT);
    else if (topic->get_type_name() != endpoint.type)
      return Error{ErrorKind::kUsage, "topic " + endpoint.topic + " has two types"};
    if (topic == nullptr) return Error{ErrorKind::kIo, "DDS refuses topic " + endpoint.topic};
    return topic;
  }

  void add(const rtps::GUID_t& guid, bool is_writer) {
    const std::lock_guard lock(mutex_);
    (is_writer ? writers_ : readers_).insert(guid);
  }
  void remove(const rtps::GUID_t& guid) {
    const std::lock_guard lock(mutex_);
    writers_.erase(guid);
    readers_.erase(guid);
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

namespace {

class RawWriter final : public DdsWriter, private dds::DataWriterListener {
 public:
  explicit RawWriter(std::function<void()> on_match) : on_match_(std::move(on_match)) {}
  ~RawWriter() override {
    if (writer_ == nullptr) return;
    forget_();
    writer_->set_listener(nullptr);
    publisher_->delete_datawriter(writer_);
  }

  Status open(dds::Publisher& publisher, dds::Topic& topic, const DdsEndpoint& endpoint) {
    dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
    set_qos(endpoint, &qos);
    qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
    if (endpoint.is_large) {
      qos.publish_mode().kind = dds::ASYNCHRONOUS_PUBLISH_MODE;
      qos.publish_mode().flow_controller_name = kPaceName;
    }
    publisher_ = &publisher;
    writer_ = publisher.create_datawriter(&topic, qos, this);
    if (writer_ == nullptr)
      return Error{ErrorKind::kIo, "DDS refuses a writer of " + endpoint.topic};
    return {};
  }
  rtps::GUID_t guid() const { return writer_->guid(); }
  void on_end(std::function<void()> forget) { forget_ = std::move(forget); }

  int readers() const override { return readers_; }
  bool write(std::span<const uint8_t> data) override {
    RawMessage message{data, {}};
    return writer_->write(&message);
  }
  bool reply(std::span<const uint8_t> data, const DdsRequest& request) override {
    {
      std::unique_lock lock(mutex_);
      came_.wait_for(lock, kReplyPatience,
                     [&] { return matched_.contains(request.writer_guid()); });
    }
    RawMessage message{data, {}};
    rtps::WriteParams parameters;
    parameters.related_sample_identity(request);
    return writer_->write(&message, parameters);
  }

 private:
  void on_publication_matched(dds::DataWriter*,
                              const dds::PublicationMatchedStatus& status) override {
    {
      const std::lock_guard lock(mutex_);
      rtps::GUID_t reader;
      rtps::iHandle2GUID(reader, status.last_subscription_handle);
      if (status.current_count_change > 0)
        matched_.insert(reader);
      else
        matched_.erase(reader);
      readers_ = status.current_count;
    }
    came_.notify_all();
    if (on_match_) on_match_();
  }

  const std::function<void()> on_match_;
  std::function<void()> forget_;
  dds::Publisher* publisher_ = nullptr;
  dds::DataWriter* writer_ = nullptr;
  std::atomic<int> readers_{0};
  std::mutex mutex_;
  std::condition_variable came_;
  std::set<rtps::GUID_t> matched_;
};

class RawReader final : public DdsReader, private dds::DataReaderListener {
 public:
  explicit RawReader(std::function<void(const DdsSample&)> on_sample)
      : on_sample_(std::move(on_sample)) {}
  ~RawReader() override {
    if (reader_ == nullptr) return;
    forget_();
    reader_->set_listener(nullptr);
    subscriber_->delete_datareader(reader_);
  }

  Status open(dds::Subscriber& subscriber, dds::Topic& topic, const DdsEndpoint& endpoint) {
    dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
    set_qos(endpoint, &qos);
    subscriber_ = &subscriber;
    reader_ = subscriber.create_datareader(&topic, qos, this);
    if (reader_ == nullptr)
      return Error{ErrorKind::kIo, "DDS refuses a reader of " + endpoint.topic};
    return {};
  }
  rtps::GUID_t guid() const { return reader_->guid(); }
  void on_end(std::function<void()> forget) { forget_ = std::move(forget); }
  int writers() const override { return writers_; }

 private:
  void on_data_available(dds::DataReader* reader) override {
    RawMessage message;
    dds::SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      const rtps::GUID_t& guid = info.sample_identity.writer_guid();
      DdsSample sample{message.own, {}, requester(info)};
      sample.writer.assign(reinterpret_cast<const char*>(guid.guidPrefix.value), 12);
      sample.writer.append(reinterpret_cast<const char*>(guid.entityId.value), 4);
      on_sample_(sample);
    }
  }
  void on_subscription_matched(dds::DataReader*,
                               const dds::SubscriptionMatchedStatus& status) override {
    writers_ = status.current_count;
  }

  const std::function<void(const DdsSample&)> on_sample_;
  std::function<void()> forget_;
  dds::Subscriber* subscriber_ = nullptr;
  dds::DataReader* reader_ = nullptr;
  std::atomic<int> writers_{0};
};

}  // namespace

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
  auto writer = std::make_unique<RawWriter>(std::move(on_match));
  GLOAM_TRY_STATUS(writer->open(impl_->publisher(), *topic, endpoint));
  const rtps::GUID_t guid = writer->guid();
  impl_->add(guid, true);
  writer->on_end([impl = impl_.get(), guid] { impl->remove(guid); });
  return std::unique_ptr<DdsWriter>(std::move(writer));
}

Result<std::unique_ptr<DdsReader>> DdsNode::add_reader(
    const DdsEndpoint& endpoint, std::function<void(const DdsSample&)> on_sample) {
  GLOAM_TRY(dds::Topic * topic, impl_->topic(endpoint));
  auto reader = std::make_unique<RawReader>(std::move(on_sample));
  GLOAM_TRY_STATUS(reader->open(impl_->subscriber(), *topic, endpoint));
  const rtps::GUID_t guid = reader->guid();
  impl_->add(guid, false);
  reader->on_end([impl = impl_.get(), guid] { impl->remove(guid); });
  return std::unique_ptr<DdsReader>(std::move(reader));
}

void DdsNode::announce() { static_cast<void>(impl_->discovery_->write(impl_->entities())); }

}  // namespace gloam::bridge
