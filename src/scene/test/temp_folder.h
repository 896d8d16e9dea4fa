#pragma once
// Files that one test makes and that vanish with it.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/cache_writer.h"

namespace gloam {

class TempFolder {
 public:
  TempFolder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("gloam_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++)) / "a" /
            "b" / "c" / "d";  // deep enough that four levels up are still the test's own
    std::filesystem::create_directories(path_);
    path_ = std::filesystem::canonical(path_);
  }
  ~TempFolder() {
    finish_cache_writes();  // they may lie in here
    std::error_code code;
    std::filesystem::remove_all(path_.parent_path().parent_path().parent_path().parent_path(),
                                code);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Writes a file below the folder; `name` may hold folders and "..".
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = (path_ / name).lexically_normal();
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// A tetrahedron with 1 m legs.
inline std::string tetrahedron_obj() {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

}  // namespace gloam
