#include "bridge/ros2/loopback_transport.h"

#include <arpa/inet.h>
#include <ifaddrs.h>

#include <set>
#include <string>

namespace gloam::bridge {
namespace {

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

class LoopbackTransport final : public ForwardingTransport {
 public:
  using ForwardingTransport::ForwardingTransport;

 private:
  rtps::Locator_t changed(const rtps::Locator_t& remote) const override {
    rtps::Locator_t here = remote;
    if (IsLocatorSupported(remote) &&
        own_addresses().contains(rtps::IPLocator::toIPv4string(remote)))
      rtps::IPLocator::setIPv4(here, kLoopback);
    return here;
  }
};

}  // namespace

LoopbackTransportDescriptor::LoopbackTransportDescriptor()
    : ChainingTransportDescriptor(loopback_udp()) {}

transport::TransportInterface* LoopbackTransportDescriptor::create_transport() const {
  return new LoopbackTransport(*this);
}

NetworkTransportDescriptor::NetworkTransportDescriptor()
    : ChainingTransportDescriptor(std::make_shared<transport::UDPv4TransportDescriptor>()) {}

transport::TransportInterface* NetworkTransportDescriptor::create_transport() const {
  return new ForwardingTransport(*this);
}

}  // namespace gloam::bridge
