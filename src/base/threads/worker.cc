#include "base/threads/worker.h"

#include <utility>
#include <vector>

namespace gloam {
namespace {

thread_local const Worker* worker_of_thread = nullptr;

}  // namespace

Worker::Worker(size_t most, Overflow overflow)
    : waits_(overflow == Overflow::kWait),
      jobs_({.items = most}, overflow),
      thread_([this] { run(); }) {}

bool Worker::post(Job job, int64_t key) {
  const bool would_block_itself = waits_ && worker_of_thread == this;
  return jobs_.push(std::move(job), {.key = key, .is_kept = would_block_itself}) ==
         PushResult::kAdded;
}

bool Worker::post_always(Job job) {
  return jobs_.push(std::move(job), {.is_kept = true}) == PushResult::kAdded;
}

void Worker::close() {
  jobs_.close();
  if (thread_.joinable()) thread_.join();
}

void Worker::stop() {
  stopping_ = true;
  jobs_.close();
  const std::vector<Job> discarded = jobs_.take_all();  // destroyed after the thread has ended
  if (thread_.joinable()) thread_.join();
}

void Worker::run() {
  worker_of_thread = this;
  while (const auto job = jobs_.pop())
    if (!stopping_) (*job)();
}

}  // namespace gloam
