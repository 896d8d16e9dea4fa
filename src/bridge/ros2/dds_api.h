#pragma once
// Fast DDS 2 (Debian 12, Ubuntu 24.04) or Fast DDS 3 (Debian 13). Version 3 renamed headers,
// namespaces and virtual functions, and returns codes where version 2 returned true: this file is
// the only one that depends on the major version.

#if __has_include(<fastdds/rtps/common/Guid.hpp>)
#define GLOAM_FAST_DDS 3
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/rtps/common/Guid.hpp>
#include <fastdds/rtps/common/SampleIdentity.hpp>
#include <fastdds/rtps/common/WriteParams.hpp>
#include <fastdds/rtps/transport/ChainingTransport.hpp>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#else
#define GLOAM_FAST_DDS 2
#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/SampleIdentity.h>
#include <fastdds/rtps/common/WriteParams.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/ChainingTransportDescriptor.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#endif
#include <fastdds/dds/topic/TopicDataType.hpp>

#include <chrono>
#include <functional>
#include <string>
#include <thread>

namespace gloam::bridge {

namespace dds = eprosima::fastdds::dds;
namespace transport = eprosima::fastdds::rtps;
#if GLOAM_FAST_DDS >= 3
namespace rtps = eprosima::fastdds::rtps;
inline bool succeeded(dds::ReturnCode_t code) { return code == dds::RETCODE_OK; }
#else
namespace rtps = eprosima::fastrtps::rtps;
inline bool succeeded(bool done) { return done; }
inline bool succeeded(eprosima::fastrtps::types::ReturnCode_t code) {
  return code == eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK;
}
#endif

/// Whether large messages are paced by a flow controller of DDS. Version 3 then sends its own
/// announcements by that thread, too, and an assertion ends the program when two participants
/// appear before it has sent the first one (StatelessWriter::unsent_changes_reset()), so there the
/// transport paces them.
inline constexpr bool kUsesFlowController = GLOAM_FAST_DDS < 3;
constexpr uint32_t kPacedSize = 60'000;          // of messages: fragments have 65,500 [byte]
constexpr std::chrono::milliseconds kPacing{1};  // after each of them

/// A type without key whose messages derived classes copy to and from DDS's payloads.
class DdsType : public dds::TopicDataType {
 protected:
  /// `usual_size`: bytes that a payload is made with.
  DdsType(const std::string& name, uint32_t usual_size);

  virtual void write(const void* message, rtps::SerializedPayload_t* payload) const = 0;
  /// False: the message is dropped.
  virtual bool read(const rtps::SerializedPayload_t& payload, void* message) const = 0;
  virtual uint32_t size_of(const void* message) const = 0;
  virtual void* make_message() const = 0;
  virtual void delete_message(void* message) const = 0;

 private:
#if GLOAM_FAST_DDS >= 3
  using Format = dds::DataRepresentationId_t;
  bool serialize(const void* data, rtps::SerializedPayload_t& payload, Format) override {
    write(data, &payload);
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t& payload, void* data) override {
    return read(payload, data);
  }
  uint32_t calculate_serialized_size(const void* data, Format) override { return size_of(data); }
  void* create_data() override { return make_message(); }
  void delete_data(void* data) override { delete_message(data); }
  bool compute_key(rtps::SerializedPayload_t&, rtps::InstanceHandle_t&, bool) override {
    return false;
  }
  bool compute_key(const void*, rtps::InstanceHandle_t&, bool) override { return false; }
#else
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    write(data, payload);
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    return read(*payload, data);
  }
  std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
    return [size = size_of(data)] { return size; };
  }
  void* createData() override { return make_message(); }
  void deleteData(void* data) override { delete_message(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
#endif
};

inline DdsType::DdsType(const std::string& name, uint32_t usual_size) {
#if GLOAM_FAST_DDS >= 3
  set_name(name);
  max_serialized_type_size = usual_size;
  is_compute_key_provided = false;
#else
  setName(name.c_str());
  m_typeSize = usual_size;
  m_isGetKeyDefined = false;
  // Type objects of our own would describe bytes and match no other program's.
  auto_fill_type_object(false);
  auto_fill_type_information(false);
#endif
}

/// A transport that passes messages on as they are and may change the addresses of its peers.
class ForwardingTransport : public transport::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

  transport::TransportDescriptorInterface* get_configuration() override {
    return low_level_transport_->get_configuration();
  }
#if GLOAM_FAST_DDS >= 3
  bool transform_remote_locator(const rtps::Locator_t& remote, rtps::Locator_t& result,
                                bool remote_allows, bool local_allows) const override {
    return low_level_transport_->transform_remote_locator(changed(remote), result, remote_allows,
                                                          local_allows);
  }
  using Bytes = const std::vector<transport::NetworkBuffer>&;
#else
  using Bytes = const rtps::octet*;
#endif
  bool transform_remote_locator(const rtps::Locator_t& remote,
                                rtps::Locator_t& result) const override {
    return low_level_transport_->transform_remote_locator(changed(remote), result);
  }
  bool send(rtps::SenderResource* sender, Bytes bytes, uint32_t size, rtps::LocatorsIterator* begin,
            rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) override {
    const bool is_sent = sender->send(bytes, size, begin, end, timeout);
    if (!kUsesFlowController && size >= kPacedSize) std::this_thread::sleep_for(kPacing);
    return is_sent;
  }
  void receive(transport::TransportReceiverInterface* next, const rtps::octet* bytes, uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    next->OnDataReceived(bytes, size, local, remote);
  }

 private:
  /// Where a peer that announces this address is reached.
  virtual rtps::Locator_t changed(const rtps::Locator_t& remote) const { return remote; }
};

}  // namespace gloam::bridge
