#include "client.h"

#include <dirent.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

namespace gloam_zmq {
namespace {

constexpr int kTimeout = 120000;  // longest wait for an answer [ms]

std::string folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] == '/') return std::string(runtime) + "/gloam";
  return "/tmp/gloam-" + std::to_string(geteuid());
}

// Value of a key in the flat JSON that servers write.
std::string json_value(const std::string& json, const std::string& key) {
  const size_t at = json.find("\"" + key + "\": ");
  if (at == std::string::npos) return {};
  const size_t begin = at + key.size() + 4;
  if (json[begin] != '"') return json.substr(begin, json.find_first_of(",}", begin) - begin);
  std::string value;
  for (size_t i = begin + 1; i < json.size() && json[i] != '"'; ++i) {
    if (json[i] == '\\') ++i;
    value += json[i];
  }
  return value;
}

bool is_private(const std::string& path) {
  struct stat about = {};
  return lstat(path.c_str(), &about) == 0 && about.st_uid == geteuid() &&
         (about.st_mode & 077) == 0;
}

std::string text_of(const msgpack::object& map, const std::string& key) {
  for (uint32_t i = 0; i < map.via.map.size; ++i)
    if (map.via.map.ptr[i].key.as<std::string>() == key)
      return map.via.map.ptr[i].val.as<std::string>();
  return {};
}

}  // namespace

Server find_server() {
  const std::string where = folder();
  std::string newest;
  timespec newest_time = {};
  DIR* open_folder = is_private(where) ? opendir(where.c_str()) : nullptr;
  while (const dirent* entry = open_folder != nullptr ? readdir(open_folder) : nullptr) {
    const std::string path = where + "/" + entry->d_name;
    struct stat about = {};
    if (std::string(entry->d_name).rfind("zmq-", 0) != 0 || !is_private(path) ||
        stat(path.c_str(), &about) != 0)
      continue;
    std::stringstream json;
    json << std::ifstream(path).rdbuf();
    const pid_t pid = std::atoi(json_value(json.str(), "pid").c_str());
    if (pid <= 0 || kill(pid, 0) != 0) continue;
    const timespec time = about.st_mtim;
    if (newest.empty() || time.tv_sec > newest_time.tv_sec ||
        (time.tv_sec == newest_time.tv_sec && time.tv_nsec > newest_time.tv_nsec)) {
      newest = json.str();
      newest_time = time;
    }
  }
  if (open_folder != nullptr) closedir(open_folder);
  if (newest.empty()) throw Error("no server of yours runs on this machine: gloam run SCENE --zmq");
  return {json_value(newest, "address"), json_value(newest, "streams"), json_value(newest, "token"),
          json_value(newest, "public_key")};
}

Client::Client(const Server& server)
    : token_(server.token), socket_(context_, zmq::socket_type::dealer) {
  socket_.set(zmq::sockopt::linger, 0);
  socket_.set(zmq::sockopt::rcvtimeo, kTimeout);
  if (!server.public_key.empty()) {
    std::array<char, 41> mine = {}, secret = {};
    if (zmq_curve_keypair(mine.data(), secret.data()) != 0) throw Error("libzmq has no CURVE");
    socket_.set(zmq::sockopt::curve_serverkey, server.public_key);
    socket_.set(zmq::sockopt::curve_publickey, std::string(mine.data()));
    socket_.set(zmq::sockopt::curve_secretkey, std::string(secret.data()));
  }
  socket_.connect(server.address);
}

msgpack::object_handle Client::call(const std::string& operation, uint32_t count,
                                    const std::function<void(Packer&)>& arguments) {
  msgpack::sbuffer request;
  Packer packer(request);
  packer.pack_map(4);
  packer.pack(std::string("op")).pack(operation);
  packer.pack(std::string("id")).pack(++last_id_);
  packer.pack(std::string("token")).pack(token_);
  packer.pack(std::string("args")).pack_map(count);
  if (arguments) arguments(packer);
  socket_.send(zmq::buffer(request.data(), request.size()), zmq::send_flags::none);
  for (;;) {
    zmq::message_t bytes;
    if (!socket_.recv(bytes)) throw Error("no answer");
    msgpack::object_handle reply =
        msgpack::unpack(static_cast<const char*>(bytes.data()), bytes.size());
    const auto parts = reply->as<std::map<std::string, msgpack::object>>();
    const auto id = parts.find("id");
    if (id == parts.end() || (!id->second.is_nil() && id->second.as<uint64_t>() != last_id_))
      continue;  // an event, or an answer that came too late
    if (const auto error = parts.find("error"); error != parts.end())
      throw Error(text_of(error->second, "message") + " (" + text_of(error->second, "remedy") +
                  ")");
    return msgpack::object_handle(parts.at("result"), std::move(reply.zone()));
  }
}

State Client::step(int64_t n) {
  const msgpack::object_handle result =
      call("step", 1, [n](Packer& packer) { packer.pack(std::string("n")).pack(n); });
  const auto parts = result->as<std::map<std::string, msgpack::object>>();
  return {parts.at("step").as<int64_t>(),
          parts.at("time").as<double>(),
          parts.at("hash").as<uint64_t>(),
          parts.at("qpos").as<std::vector<double>>(),
          parts.at("qvel").as<std::vector<double>>(),
          parts.at("ctrl").as<std::vector<double>>()};
}

void Client::set_controls(const std::string& robot, const std::vector<double>& values) {
  call("controls", 2, [&](Packer& packer) {
    packer.pack(std::string("robot")).pack(robot);
    packer.pack(std::string("values")).pack(values);
  });
}

void Client::set_joint(const std::string& joint, double position) {
  call("joint_states", 1, [&](Packer& packer) {
    packer.pack(std::string("positions")).pack_map(1);
    packer.pack(joint).pack(std::vector<double>{position});
  });
}

}  // namespace gloam_zmq
