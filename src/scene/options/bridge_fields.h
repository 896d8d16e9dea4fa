#pragma once
// Fields of [bridge]. A part of scene/options/option_fields.h.

#include "gloam/scene/bridge.h"
#include "scene/options/field_rule.h"

namespace gloam {

template <class Visitor>
void visit_fields(Visitor& v, Ros2Options& o) {
  v("domain", o.domain, FieldRule{.min = 0, .max = 232});
  v("network", o.network, FieldRule{});
  v("node", o.node, FieldRule{.identifier = true});
  v("ns", o.ns, FieldRule{});
  v("topics", o.topics, FieldRule{});
  v("interfaces", o.interfaces, FieldRule{.min = 1, .max = 2});
}

template <class Visitor>
void visit_fields(Visitor& v, ZmqOptions& o) {
  v("host", o.host, FieldRule{});
  v("port", o.port, FieldRule{.min = 0, .max = 65534});
  v("curve_secret", o.curve_secret, FieldRule{});
  v("shared_memory", o.shared_memory, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, FoxgloveOptions& o) {
  v("host", o.host, FieldRule{});
  v("port", o.port, FieldRule{.min = 0, .max = 65535});
  v("max_clients", o.max_clients, FieldRule{.min = 1, .max = 1024});
  v("topics", o.topics, FieldRule{});
}

template <class Visitor>
void visit_fields(Visitor& v, BridgeOptions& o) {
  v("ros2", o.ros2, FieldRule{});
  v("zmq", o.zmq, FieldRule{});
  v("foxglove", o.foxglove, FieldRule{});
}

}  // namespace gloam
