#include "runtime/log/files/portable_paths.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/files/model_path.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

bool is_in(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

}  // namespace

fs::path portable_relative(const fs::path& path, const fs::path& folder) {
  if (folder.empty()) return {};
  const fs::path relative = path.lexically_relative(folder);
  fs::path common = folder;
  for (const fs::path& part : relative) {
    if (part != "..") break;
    common = common.parent_path();
    if (holds_homes(common)) return {};
  }
  return relative;
}

fs::path common_folder(const std::vector<fs::path>& files) {
  if (files.empty()) return {};
  fs::path common = files.front().parent_path();
  for (const fs::path& file : files)
    while (!is_in(file, common)) common = common.parent_path();
  return holds_homes(common) ? fs::path() : common;
}

PortablePaths::PortablePaths(fs::path folder, const std::vector<fs::path>& files,
                             const std::vector<fs::path>& packages)
    : folder_(std::move(folder)) {
  std::vector<fs::path> roots;
  for (const fs::path& package : packages)
    if (portable_relative(package, folder_).empty()) roots.push_back(package);
  for (const fs::path& file : files)
    if (portable_relative(file, folder_).empty()) roots.push_back(candidate_roots(file).back());
  const auto depth = [](const fs::path& path) { return std::distance(path.begin(), path.end()); };
  std::ranges::stable_sort(roots, {}, depth);
  for (const fs::path& root : roots) {
    const auto holds_root = [&root](const fs::path& known) { return is_in(root, known); };
    if (std::ranges::none_of(outside_, holds_root)) outside_.push_back(root);
  }
}

std::string PortablePaths::name(const fs::path& path) const {
  if (const fs::path near = portable_relative(path, folder_); !near.empty()) return near.string();
  for (size_t i = 0; i < outside_.size(); ++i)
    if (is_in(path, outside_[i]))
      return (fs::path("_outside") / std::to_string(i) / path.lexically_relative(outside_[i]))
          .lexically_normal()
          .string();
  return (fs::path("_outside") / path.filename()).string();
}

}  // namespace gloam
