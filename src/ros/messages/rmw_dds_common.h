#pragma once
// Messages of ROS 2's package rmw_dds_common, as of Iron: which node has which endpoints.

#include "ros/message.h"

namespace gloam::rmw_dds_common {

inline constexpr std::string_view kPackage = "rmw_dds_common/msg";

/// An RTPS GUID. Humble's has 24 characters.
struct Gid {
  std::array<char, 16> data = {};
  GLOAM_MESSAGE(Gid, data)
};

struct NodeEntitiesInfo {
  BoundedString<256> node_namespace, node_name;
  std::vector<Gid> reader_gid_seq, writer_gid_seq;
  GLOAM_MESSAGE(NodeEntitiesInfo, node_namespace, node_name, reader_gid_seq, writer_gid_seq)
};

struct ParticipantEntitiesInfo {
  Gid gid;
  std::vector<NodeEntitiesInfo> node_entities_info_seq;
  GLOAM_MESSAGE(ParticipantEntitiesInfo, gid, node_entities_info_seq)
};

}  // namespace gloam::rmw_dds_common
