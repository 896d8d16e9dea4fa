#pragma once
// StagedFiles: a folder in the cache in which files of a logged scene are put together.

#include <cstdint>
#include <filesystem>
#include <span>

#include "runtime/log/run_text.h"

namespace gloam {

class StagedFiles {
 public:
  /// Errors: a name of the log that leads out of the folder.
  static Result<StagedFiles> make(const RunText& text);

  /// Writes a file of the run, unless it is there already. Error: the disk.
  Status add(const RunText::File& file, std::span<const uint8_t> bytes) const;
  /// Where the scene finds its files; it may read nothing else.
  SceneFolder folder(const RunText& text) const;

 private:
  std::filesystem::path root_, scene_;
};

}  // namespace gloam
