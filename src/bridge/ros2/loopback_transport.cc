#include "bridge/ros2/loopback_transport.h"

#include <arpa/inet.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <ifaddrs.h>

#include <set>
#include <string>

namespace gloam::bridge {
namespace {

using eprosima::fastrtps::rtps::IPLocator;
using eprosima::fastrtps::rtps::Locator_t;
namespace transport = eprosima::fastdds::rtps;

constexpr const char* kLoopback = "127.0.0.1";

std::shared_ptr<transport::UDPv4TransportDescriptor> loopback_udp() {
  auto udp = std::make_shared<transport::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {kLoopback};
  return udp;
}

// IPv4 addresses of this machine.
std::set<std::string> own_addresses() {
  std::set<std::string> addresses;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return addresses;
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN];
    const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (inet_ntop(AF_INET, &address->sin_addr, text, sizeof(text)) != nullptr)
      addresses.insert(text);
  }
  freeifaddrs(list);
  return addresses;
}

class LoopbackTransport final : public transport::ChainingTransport {
 public:
  using ChainingTransport::ChainingTransport;

  transport::TransportDescriptorInterface* get_configuration() override {
    return low_level_transport_->get_configuration();
  }
  bool transform_remote_locator(const Locator_t& remote, Locator_t& result) const override {
    Locator_t here = remote;
    if (IsLocatorSupported(remote) && own_addresses().contains(IPLocator::toIPv4string(remote)))
      IPLocator::setIPv4(here, kLoopback);
    return low_level_transport_->transform_remote_locator(here, result);
  }
  bool send(eprosima::fastrtps::rtps::SenderResource* sender,
            const eprosima::fastrtps::rtps::octet* bytes, uint32_t size,
            eprosima::fastrtps::rtps::LocatorsIterator* begin,
            eprosima::fastrtps::rtps::LocatorsIterator* end,
            const std::chrono::steady_clock::time_point& timeout) override {
    return sender->send(bytes, size, begin, end, timeout);
  }
  void receive(transport::TransportReceiverInterface* next,
               const eprosima::fastrtps::rtps::octet* bytes, uint32_t size, const Locator_t& local,
               const Locator_t& remote) override {
    next->OnDataReceived(bytes, size, local, remote);
  }
};

}  // namespace

LoopbackTransportDescriptor::LoopbackTransportDescriptor()
    : ChainingTransportDescriptor(loopback_udp()) {}

transport::TransportInterface* LoopbackTransportDescriptor::create_transport() const {
  return new LoopbackTransport(*this);
}

}  // namespace gloam::bridge
