#pragma once
// Gloam's own messages, for what ROS has none.

#include "ros/messages/geometry_msgs.h"

namespace gloam::gloam_msgs {

inline constexpr std::string_view kPackage = "gloam_msgs/msg";

/// A contact of two geoms at one point, world frame.
struct Contact {
  std::string body1, body2, geom1, geom2;  ///< full names
  geometry_msgs::Point position;           ///< [m]
  geometry_msgs::Vector3 normal;           ///< unit, from geom1 to geom2
  geometry_msgs::Wrench wrench;            ///< on body1, about `position` [N, N m]
  double depth = 0;                        ///< of the penetration [m]; negative = a gap
  GLOAM_MESSAGE(Contact, body1, body2, geom1, geom2, position, normal, wrench, depth)
};

struct Contacts {
  std_msgs::Header header;
  std::vector<Contact> contacts;
  GLOAM_MESSAGE(Contacts, header, contacts)
};

/// Where a simulation stands at an instant: of Gloam's own, for replays.
struct State {
  std_msgs::Header header;
  int64_t run = 0, step = 0;  ///< resets before it; physics steps since the last
  uint64_t hash = 0;          ///< of the state, chained over all steps of the run
  std::vector<double> state;  ///< mjSTATE_INTEGRATION
  GLOAM_MESSAGE(State, header, run, step, hash, state)
};

/// Numbers of the state that a program wrote before a step, beside Commands: for replays.
struct StepInput {
  std_msgs::Header header;
  int64_t run = 0, step = 0;
  std::vector<int32_t> index;  ///< in mjSTATE_INTEGRATION
  std::vector<double> value;
  GLOAM_MESSAGE(StepInput, header, run, step, index, value)
};

}  // namespace gloam::gloam_msgs
