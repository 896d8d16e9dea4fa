#pragma once
// Requests and responses of ROS 2's package std_srvs.

#include "ros/message.h"

namespace gloam::std_srvs {

inline constexpr std::string_view kPackage = "std_srvs/srv";

struct Empty_Request {
  GLOAM_MESSAGE(Empty_Request)
};

struct Empty_Response {
  GLOAM_MESSAGE(Empty_Response)
};

struct Trigger_Request {
  GLOAM_MESSAGE(Trigger_Request)
};

struct Trigger_Response {
  bool success = false;
  std::string message;
  GLOAM_MESSAGE(Trigger_Response, success, message)
};

struct SetBool_Request {
  bool data = false;
  GLOAM_MESSAGE(SetBool_Request, data)
};

struct SetBool_Response {
  bool success = false;
  std::string message;
  GLOAM_MESSAGE(SetBool_Response, success, message)
};

}  // namespace gloam::std_srvs
