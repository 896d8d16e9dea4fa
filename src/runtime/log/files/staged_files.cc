#include "runtime/log/files/staged_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/cache.h"
#include "base/files.h"
#include "base/hash.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr int kMaxParentLevels = 16;  // levels that a scene's files may lie above it
constexpr std::chrono::hours kRetentionTime{24 * 30};  // unused folders are removed after a month

fs::path staging_folder() { return cache_folder() / "replays"; }

// Removes what no replay has used for long; a folder's time is that of its last use.
void remove_old_folders() {
  std::error_code code;
  fs::directory_iterator it(staging_folder(), code);
  for (const fs::directory_iterator end; !code && it != end; it.increment(code)) {
    const std::string name = it->path().filename().string();
    const bool is_ours =
        name.size() == 16 && name.find_first_not_of("0123456789abcdef") == std::string::npos;
    std::error_code other;
    const auto used = fs::last_write_time(it->path(), other);
    if (is_ours && !other && fs::file_time_type::clock::now() - used > kRetentionTime)
      fs::remove_all(it->path(), other);
  }
}

// Levels above the scene's folder to which a name leads.
int levels_up(const fs::path& name) {
  const fs::path normal = name.lexically_normal();
  return static_cast<int>(std::count(normal.begin(), normal.end(), ".."));
}

}  // namespace

Result<StagedFiles> StagedFiles::make(const RunText& text) {
  std::vector<std::string> names;
  for (const RunText::File& file : text.files) names.push_back(file.path);
  for (const RunText::Package& package : text.packages) names.push_back(package.folder);
  int up = 0;
  for (const std::string& name : names) {
    const int levels = levels_up(name);
    if (fs::path(name).is_absolute() || levels > kMaxParentLevels)
      return Error{ErrorKind::kInput,
                   fmt::format("the log's scene refers to '{:.80}', outside its folder", name)};
    up = std::max(up, levels);
  }
  uint64_t key = 0;
  for (const RunText::File& file : text.files) {
    key = hash_bytes(file.path.data(), file.path.size(), key);
    key = hash_bytes(&file.hash, sizeof(file.hash), key);
  }
  remove_old_folders();
  StagedFiles staged;
  staged.root_ = staging_folder() / hash_to_hex(key);
  staged.scene_ = staged.root_ / "scene";
  for (int i = 0; i < up; ++i) staged.scene_ /= "scene";
  GLOAM_TRY_STATUS(make_folder(staged.scene_));
  std::error_code code;
  fs::last_write_time(staged.root_, fs::file_time_type::clock::now(), code);
  return staged;
}

Status StagedFiles::add(const RunText::File& file, std::span<const uint8_t> bytes) const {
  if (is_in_place(scene_, file)) return {};
  const fs::path path = path_in(scene_, file);
  GLOAM_TRY_STATUS(make_folder(path.parent_path()));
  return write_file_atomic(path, bytes);
}

SceneFolder StagedFiles::folder(const RunText& text) const {
  SceneFolder found{scene_, {.root = root_}};
  for (const RunText::Package& package : text.packages)
    found.access.packages.emplace_back(package.name, (scene_ / package.folder).lexically_normal());
  return found;
}

}  // namespace gloam
