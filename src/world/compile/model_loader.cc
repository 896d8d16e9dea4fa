#include "world/compile/model_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>

#include "base/cache.h"
#include "base/log.h"
#include "base/parallel.h"
#include "geometry/mesh/model_file_cache.h"
#include "scene/files/model_path.h"
#include "world/compile/progress/compile_progress.h"
#include "world/compile/progress/load_progress.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

/// Folder that the file's own pictures and libraries must lie in.
Result<fs::path> root_of(const Scene& scene, const fs::path& file) {
  GLOAM_TRY(const ModelRoot root,
            find_model_root(scene.file.empty() ? file : scene.file, scene.access));
  std::vector<fs::path> folders;
  if (!root.is_wide) folders.push_back(root.canonical);
  std::error_code code;
  for (const auto& [name, folder] : scene.access.packages)
    folders.push_back(fs::weakly_canonical(folder, code));
  const fs::path canonical = fs::weakly_canonical(file, code);
  for (const fs::path& folder : folders) {
    const fs::path below = canonical.lexically_relative(folder);
    if (!below.empty() && *below.begin() != "..") return folder;
  }
  return canonical.parent_path();
}

}  // namespace

Error said_of(const std::string& user, const SourceLoc& loc, const Error& error) {
  return {error.kind, fmt::format("{}: {}", user, error.message), loc, error.hint};
}

Result<ModelFile> load_model_file(const Scene& scene, const fs::path& file, const std::string& user,
                                  const SourceLoc& loc,
                                  const std::function<void(double share)>& progress) {
  ModelFileOptions options;
  GLOAM_TRY(options.root, root_of(scene, file));
  options.progress = progress;
  Result<ModelFile> model = read_model_file_cached(file, cache_folder(kVisualCache), options);
  if (model.ok()) return model;
  const Error& error = model.error();
  const std::string told = Error{error.kind, error.message, error.loc}.to_string();
  return said_of(user, loc, {error.kind, told, {}, error.hint});
}

Result<std::vector<LoadedModel>> load_model_files(const Scene& scene,
                                                  const std::vector<FileUse>& uses,
                                                  CompileProgress* progress) {
  std::vector<const FileUse*> first;  // first use of each file
  std::set<fs::path> known;
  for (const FileUse& use : uses)
    if (known.insert(use.path).second) first.push_back(&use);
  std::vector<uint64_t> sizes;
  for (const FileUse* use : first) {
    std::error_code code;
    const uintmax_t size = fs::file_size(use->path, code);
    sizes.push_back(code ? 0 : size);
  }
  LoadProgress load(sizes);
  const auto start = std::chrono::steady_clock::now();
  const auto report = [&](size_t file, double share) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    const std::string text = load.report(file, share, passed.count());
    if (progress != nullptr && progress->is_watched()) {
      progress->report(load.share());
    } else if (!text.empty()) {
      log_info("{}", text);
    }
  };
  std::vector<std::optional<Result<ModelFile>>> read(first.size());
  parallel_for("model files", static_cast<int64_t>(first.size()), [&](int64_t i) {
    const auto k = static_cast<size_t>(i);
    if (progress != nullptr && progress->is_cancelled()) return;
    read[k] = load_model_file(scene, first[k]->path, first[k]->user, first[k]->loc,
                              [&](double share) { report(k, share); });
    report(k, 1);
  });
  if (progress != nullptr) GLOAM_TRY_STATUS(progress->check());
  std::vector<LoadedModel> out;
  for (size_t i = 0; i < first.size(); ++i) {
    GLOAM_TRY(ModelFile model, std::move(*read[i]));
    out.push_back({first[i]->path, first[i]->path.filename().string(), std::move(model)});
  }
  return out;
}

}  // namespace gloam
