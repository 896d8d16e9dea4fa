#include "base/threads/stream_set.h"

#include <mutex>
#include <utility>

namespace gloam {

void StreamSet::add(const std::string& name, std::unique_ptr<Stream> stream) {
  const std::unique_lock lock(mutex_);
  streams_[name] = std::move(stream);
}

// The stream ends after the lock is released, because its last callback may call dropped().
void StreamSet::close(const std::string& name) {
  std::unique_ptr<Stream> closing;
  const std::unique_lock lock(mutex_);
  const auto found = streams_.find(name);
  if (found == streams_.end()) return;
  closing = std::move(found->second);
  lost_before_ += closing->dropped();
  streams_.erase(found);
}

int64_t StreamSet::dropped() const {
  const std::shared_lock lock(mutex_);
  int64_t dropped = lost_before_;
  for (const auto& [name, stream] : streams_) dropped += stream->dropped();
  return dropped;
}

}  // namespace gloam
