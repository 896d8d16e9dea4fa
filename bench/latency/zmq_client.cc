// Clients of the bridge to ZeroMQ: over its socket, and through shared memory.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <map>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "bench/latency/latency.h"
#include "bridge/zmq/pack.h"

namespace gloam::latency {
namespace {

using bridge::zeromq::pack_pair;
using bridge::zeromq::PackBuffer;
using bridge::zeromq::Packer;
using Map = std::map<std::string, msgpack::object>;

/// A message and what keeps it.
struct Unpacked {
  msgpack::object_handle memory;
  Map map;
};
Unpacked unpack(const zmq::message_t& message) {
  Unpacked all{msgpack::unpack(message.data<char>(), message.size()), {}};
  all.map = all.memory->as<Map>();
  return all;
}

// Asks the bridge where its streams are; its address is "tcp://…, token …".
std::string streams_of(zmq::context_t& context, const std::string& address) {
  zmq::socket_t socket(context, zmq::socket_type::req);
  socket.set(zmq::sockopt::linger, 0);
  socket.connect(address.substr(0, address.find(',')));
  PackBuffer request;
  Packer packer(request);
  packer.pack_map(1);
  pack_pair(packer, "op", std::string_view("hello"));
  socket.send(zmq::buffer(request.data(), request.size()), zmq::send_flags::none);
  zmq::message_t reply;
  if (!socket.recv(reply)) return {};
  return unpack(reply).map.at("result").as<Map>().at("streams").as<std::string>();
}

/// A ring in shared memory; laid out as docs/zmq.md says.
class RingView {
 public:
  ~RingView() { unmap(); }
  /// The message at a place; nullptr where it was overwritten or cannot be mapped.
  const uint8_t* find(const Map& place) {
    if (const auto name = place.at("name").as<std::string>(); name != name_) map(name);
    const auto slot = place.at("slot").as<size_t>(), offset = place.at("offset").as<size_t>();
    if (memory_ == nullptr || offset + place.at("bytes").as<size_t>() > size_) return nullptr;
    const auto* sequence = reinterpret_cast<const uint64_t*>(memory_ + 64 + 16 * slot);
    const bool is_there =
        __atomic_load_n(sequence, __ATOMIC_ACQUIRE) == place.at("sequence").as<uint64_t>();
    return is_there ? memory_ + offset : nullptr;
  }

 private:
  void map(const std::string& name) {
    unmap();
    name_ = name;
    const int fd = shm_open(name.c_str(), O_RDONLY | O_CLOEXEC, 0);
    struct stat about = {};
    if (fd < 0) return;
    if (fstat(fd, &about) == 0) {
      size_ = static_cast<size_t>(about.st_size);
      void* memory = mmap(nullptr, size_, PROT_READ, MAP_SHARED, fd, 0);
      if (memory != MAP_FAILED) memory_ = static_cast<const uint8_t*>(memory);
    }
    close(fd);
  }
  void unmap() {
    if (memory_ != nullptr) munmap(const_cast<uint8_t*>(memory_), size_);
    memory_ = nullptr;
  }

  std::string name_;
  const uint8_t* memory_ = nullptr;
  size_t size_ = 0;
};

int read_stream(const std::string& address, const std::string& subscription, int out) {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::sub);
  socket.set(zmq::sockopt::linger, 0);
  socket.connect(streams_of(context, address));
  socket.set(zmq::sockopt::subscribe, subscription);
  RingView ring;
  for (;;) {
    zmq::message_t topic, header, payload;
    if (!socket.recv(topic) || !socket.recv(header) || !socket.recv(payload)) return 1;
    if (topic.to_string_view() != subscription) continue;
    const Unpacked head = unpack(header);
    if (head.map.contains("error")) return 1;
    uint64_t bytes = payload.size();
    if (const auto place = head.map.find("shm"); place != head.map.end()) {
      const Map where = place->second.as<Map>();
      if (ring.find(where) == nullptr) continue;
      bytes = where.at("bytes").as<uint64_t>();
    }
    const double at = now_ms();
    const double time = head.map.at("time").as<double>();
    if (!tell(out, {static_cast<uint64_t>(std::llround(1e9 * time)), at, bytes})) return 0;
  }
}

}  // namespace

int run_zmq_client(const std::string& address, const std::string& topic, int out) {
  return read_stream(address, topic, out);
}

int run_shm_client(const std::string& address, const std::string& topic, int out) {
  return read_stream(address, "shm" + topic, out);
}

}  // namespace gloam::latency
