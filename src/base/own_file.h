#pragma once
// Files that this process writes over a long time, guarded against other processes: locks that
// stop a second writer, and checks that notice when somebody removes or cuts a file meanwhile.

#include <cstdint>
#include <filesystem>

#include "gloam/result.h"

namespace gloam {

/// Locks the open file or folder `fd` (flock) until it is closed. File systems without locks are
/// left unlocked. Error: another process, or another part of this one, writes it.
Status lock_for_writing(int fd, const std::filesystem::path& path);

/// Removes the file at `path`, if there is one, so that a new one can take its place. Errors:
/// another process writes it; it cannot be removed.
Status remove_unless_written(const std::filesystem::path& path);

/// Error: the open file `fd`, of which `size` bytes were written, was removed or cut.
Status check_not_cut(int fd, const std::filesystem::path& path, uint64_t size);
/// The same, and whether `path` still names this file: it may have been moved or replaced.
Status check_in_place(int fd, const std::filesystem::path& path, uint64_t size);

/// A folder that this process writes into, locked while this lives.
class FolderLock {
 public:
  FolderLock() = default;
  ~FolderLock() { release(); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  /// Once. Error: another process writes into it.
  Status take(const std::filesystem::path& folder);
  /// Error: the folder was removed, moved or replaced.
  Status check() const;
  void release();

 private:
  int fd_ = -1;
  std::filesystem::path folder_;
};

}  // namespace gloam
