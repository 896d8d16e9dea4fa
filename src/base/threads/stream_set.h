#pragma once
// StreamSet: the open streams of one reader. One thread opens and closes them while others ask for
// their losses.

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <shared_mutex>
#include <string>

#include "gloam/stream.h"

namespace gloam {

class StreamSet {
 public:
  // ---- the thread that opens and closes them ----
  bool has(const std::string& name) const { return streams_.contains(name); }
  size_t size() const { return streams_.size(); }
  void add(const std::string& name, std::unique_ptr<Stream> stream);
  /// Waits for the last callback of the stream. Does nothing if there is no such stream.
  void close(const std::string& name);

  // ---- any thread ----
  /// Messages that the streams have lost, closed ones included.
  int64_t dropped() const;
  /// Calls `visit(Stream&)` for each stream; none is closed meanwhile.
  template <class Visit>
  void each(const Visit& visit) const {
    const std::shared_lock lock(mutex_);
    for (const auto& [name, stream] : streams_) visit(*stream);
  }

 private:
  mutable std::shared_mutex mutex_;
  int64_t lost_before_ = 0;  // by streams that are closed
  std::map<std::string, std::unique_ptr<Stream>> streams_;
};

}  // namespace gloam
