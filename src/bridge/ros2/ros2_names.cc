#include "bridge/ros2/ros2_names.h"

#include <cctype>

namespace gloam::bridge {

std::string dds_topic(std::string_view topic) { return "rt" + std::string(topic); }

std::string dds_request(std::string_view service) {
  return "rq" + std::string(service) + "Request";
}

std::string dds_reply(std::string_view service) { return "rr" + std::string(service) + "Reply"; }

std::string dds_type(std::string_view type, std::string_view suffix) {
  std::string name;
  const size_t last = type.rfind('/');
  for (const char c : type.substr(0, last))
    name += c == '/' ? std::string("::") : std::string(1, c);
  return name + "::dds_::" + std::string(type.substr(last + 1)) + std::string(suffix) + "_";
}

std::string ros_name(std::string_view text) {
  std::string name(text);
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '/') c = '_';
  return name;
}

}  // namespace gloam::bridge
