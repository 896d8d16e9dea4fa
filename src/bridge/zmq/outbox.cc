#include "bridge/zmq/outbox.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>

namespace gloam::bridge::zeromq {
namespace {

// Limits of the queue of one topic.
constexpr QueueLimits kTopicLimits = {.items = 256, .bytes = size_t{16} << 20};

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
  std::vector<Publication> dropped;
  {
    const std::lock_guard lock(mutex_);
    const auto queue = queues_.try_emplace(publication.topic, kTopicLimits, Overflow::kDropOldest);
    const size_t bytes = publication.bytes();
    queue.first->second.push(std::move(publication), {.bytes = bytes}, &dropped);
  }
  dropped_ += static_cast<int64_t>(dropped.size());
  wake();
}

std::vector<Reply> Outbox::take_replies() {
  const std::lock_guard lock(mutex_);
  return std::exchange(replies_, {});
}

std::vector<Publication> Outbox::take_publications() {
  std::map<std::string, BoundedQueue<Publication>> queues;
  {
    const std::lock_guard lock(mutex_);
    queues.swap(queues_);
  }
  std::vector<Publication> all;
  for (auto& [topic, queue] : queues)
    for (Publication& publication : queue.take_all()) all.push_back(std::move(publication));
  return all;
}

}  // namespace gloam::bridge::zeromq
