#include "bridge/ros2/dds_endpoints.h"

#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <set>

#include "bridge/ros2/raw_type.h"

namespace gloam::bridge {
namespace {

constexpr auto kReplyTimeout = std::chrono::milliseconds(500);

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

// Addressee of a reply: rmw_fastrtps gives the GUID of its client's reader beside it.
DdsRequest requester(const dds::SampleInfo& info) {
  DdsRequest request = info.sample_identity;
  const rtps::GUID_t& reader = info.related_sample_identity.writer_guid();
  if (reader != rtps::GUID_t::unknown()) request.writer_guid(reader);
  return request;
}

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
      if (kUsesFlowController) qos.publish_mode().flow_controller_name = kLargeMessageFlow;
    }
    publisher_ = &publisher;
    writer_ = publisher.create_datawriter(&topic, qos, this);
    if (writer_ == nullptr)
      return Error{ErrorKind::kIo, "DDS cannot create a writer for " + endpoint.topic};
    return {};
  }
  rtps::GUID_t guid() const { return writer_->guid(); }
  void on_end(std::function<void()> forget) { forget_ = std::move(forget); }

  int readers() const override { return readers_; }
  bool write(std::span<const uint8_t> data) override {
    RawMessage message{data, {}};
    return succeeded(writer_->write(&message));
  }
  bool reply(std::span<const uint8_t> data, const DdsRequest& request) override {
    {
      std::unique_lock lock(mutex_);
      came_.wait_for(lock, kReplyTimeout, [&] { return matched_.contains(request.writer_guid()); });
    }
    RawMessage message{data, {}};
    rtps::WriteParams parameters;
    parameters.related_sample_identity(request);
    return succeeded(writer_->write(&message, parameters));
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
      return Error{ErrorKind::kIo, "DDS cannot create a reader for " + endpoint.topic};
    return {};
  }
  rtps::GUID_t guid() const { return reader_->guid(); }
  void on_end(std::function<void()> forget) { forget_ = std::move(forget); }
  int writers() const override { return writers_; }

 private:
  void on_data_available(dds::DataReader* reader) override {
    RawMessage message;
    dds::SampleInfo info;
    while (succeeded(reader->take_next_sample(&message, &info))) {
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

Result<std::unique_ptr<DdsWriter>> open_writer(dds::Publisher& publisher, dds::Topic& topic,
                                               const DdsEndpoint& endpoint, WriterEvents events) {
  auto writer = std::make_unique<RawWriter>(std::move(events.on_match));
  GLOAM_TRY_STATUS(writer->open(publisher, topic, endpoint));
  const rtps::GUID_t guid = writer->guid();
  events.on_begin(guid);
  writer->on_end([guid, on_end = std::move(events.on_end)] { on_end(guid); });
  return std::unique_ptr<DdsWriter>(std::move(writer));
}

Result<std::unique_ptr<DdsReader>> open_reader(dds::Subscriber& subscriber, dds::Topic& topic,
                                               const DdsEndpoint& endpoint, ReaderEvents events) {
  auto reader = std::make_unique<RawReader>(std::move(events.on_sample));
  GLOAM_TRY_STATUS(reader->open(subscriber, topic, endpoint));
  const rtps::GUID_t guid = reader->guid();
  events.on_begin(guid);
  reader->on_end([guid, on_end = std::move(events.on_end)] { on_end(guid); });
  return std::unique_ptr<DdsReader>(std::move(reader));
}

}  // namespace gloam::bridge
