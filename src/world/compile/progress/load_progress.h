#pragma once
// Progress of reading several files together.

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace gloam {

class LoadProgress {
 public:
  /// `bytes` = sizes of the files.
  explicit LoadProgress(const std::vector<uint64_t>& bytes);

  /// At `seconds` since the start `share` of one file is read. What to tell now, which is nothing
  /// before 2 s nor within 2 s of the last: "reading model files: 1 of 4, 120 of 410 MB, about 5 s
  /// left". From any thread.
  std::string report(size_t file, double share, double seconds);
  /// Fraction of all bytes that are read, 0 … 1. From any thread.
  double share() const;

 private:
  struct File {
    double bytes, share;
  };
  mutable std::mutex mutex_;
  std::vector<File> files_;
  double told_ = 0;  // when, last [s]
};

}  // namespace gloam
