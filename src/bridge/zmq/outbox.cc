#include "bridge/zmq/outbox.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>

namespace gloam::bridge::zeromq {
namespace {

constexpr size_t kMaxQueuedMessages = 256;            // messages of a topic
constexpr size_t kMaxQueuedBytes = size_t{16} << 20;  // of a topic, but for the newest message

}  // namespace

Result<std::unique_ptr<Outbox>> Outbox::create() {
  const int fd = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  if (fd < 0) return Error{ErrorKind::kIo, "no event file descriptor: too many open files"};
  return std::unique_ptr<Outbox>(new Outbox(fd));
}

Outbox::~Outbox() { close(wake_fd_); }

void Outbox::wake() {
  const uint64_t one = 1;
  (void)!write(wake_fd_, &one, sizeof one);  // full = awake already
}

void Outbox::clear_wake() {
  uint64_t count = 0;
  (void)!read(wake_fd_, &count, sizeof count);
}

void Outbox::reply(Reply reply) {
  {
    const std::lock_guard lock(mutex_);
    replies_.push_back(std::move(reply));
  }
  wake();
}

void Outbox::publish(Publication publication) {
  {
    const std::lock_guard lock(mutex_);
    Queue& queue = queues_[publication.topic];
    queue.bytes += publication.bytes();
    queue.waiting.push_back(std::move(publication));
    while (queue.waiting.size() > kMaxQueuedMessages ||
           (queue.waiting.size() > 1 && queue.bytes > kMaxQueuedBytes)) {
      queue.bytes -= queue.waiting.front().bytes();
      queue.waiting.pop_front();
      ++dropped_;
    }
  }
  wake();
}

std::vector<Reply> Outbox::take_replies() {
  const std::lock_guard lock(mutex_);
  return std::exchange(replies_, {});
}

std::vector<Publication> Outbox::take_publications() {
  std::map<std::string, Queue> queues;
  {
    const std::lock_guard lock(mutex_);
    queues.swap(queues_);
  }
  std::vector<Publication> all;
  for (auto& [topic, queue] : queues)
    for (Publication& publication : queue.waiting) all.push_back(std::move(publication));
  return all;
}

}  // namespace gloam::bridge::zeromq
