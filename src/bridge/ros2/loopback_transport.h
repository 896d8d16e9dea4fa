#pragma once
// Transports of the node. LoopbackTransport: UDP that listens and sends on loopback alone, and yet
// reaches programs of this machine that announce the addresses of its network cards, as all do by
// default. Fast DDS 2.9 would leave such addresses out (its pull request 3733).

#include "bridge/ros2/dds_api.h"

namespace gloam::bridge {

class LoopbackTransportDescriptor final : public transport::ChainingTransportDescriptor {
 public:
  LoopbackTransportDescriptor();
  transport::TransportInterface* create_transport() const override;
};

/// UDP on all network cards, paced where DDS does not do it.
class NetworkTransportDescriptor final : public transport::ChainingTransportDescriptor {
 public:
  NetworkTransportDescriptor();
  transport::TransportInterface* create_transport() const override;
};

}  // namespace gloam::bridge
