#pragma once
// Reads model files out of memory and folders of tests.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

#include "base/cache_writer.h"
#include "geometry/mesh/model_source.h"

namespace gloam {

inline bool operator==(Vec2f a, Vec2f b) { return a.x == b.x && a.y == b.y; }
inline void PrintTo(Vec3f v, std::ostream* out) {
  *out << '(' << v.x << ' ' << v.y << ' ' << v.z << ')';
}
inline void PrintTo(Vec2f v, std::ostream* out) { *out << '(' << v.x << ' ' << v.y << ')'; }

inline std::span<const uint8_t> as_bytes(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

/// Reads a file that exists in memory only. `name` = what it would be called.
inline Result<ModelFile> read_text(const std::string& content, const std::string& name,
                                   const ModelFileOptions& options = {}) {
  return read_model_bytes({name, as_bytes(content), nullptr, &options});
}

inline std::string error_of(const Result<ModelFile>& result) {
  return result.ok() ? "no error" : result.error().to_string();
}

/// A folder of its own for a test, removed at its end.
class TestFolder {
 public:
  TestFolder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path = std::filesystem::temp_directory_path() /
           ("gloam_" + std::to_string(::getpid()) + "_" + test->name());
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  ~TestFolder() {
    finish_cache_writes();  // they may lie in here
    std::filesystem::remove_all(path);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path / name).parent_path());
    std::ofstream(path / name, std::ios::binary) << content;
    return path / name;
  }
  std::filesystem::path path;
};

}  // namespace gloam
