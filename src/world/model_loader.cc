#include "world/model_loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>

#include "base/cache.h"
#include "base/log.h"
#include "base/parallel.h"
#include "geometry/model_file_cache.h"
#include "scene/model_path.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

/// Tells of files that take long, every two seconds.
class SlowProgress {
 public:
  explicit SlowProgress(std::string name) : name_(std::move(name)) {}
  /// One call at a time.
  void operator()(double share) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::seconds(2) || share >= 1) return;
    last_ = now;
    log_info("reading {}: {:.0f} %", name_, 100 * share);
  }

 private:
  std::string name_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

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

Result<ModelFile> load(const Scene& scene, const VisualOptions& visual, const fs::path& cache) {
  ModelFileOptions options;
  GLOAM_TRY(options.root, root_of(scene, visual.file));
  options.progress = SlowProgress(visual.file.filename().string());
  Result<ModelFile> model = read_model_file_cached(visual.file, cache, options);
  if (model.ok()) return model;
  const Error& error = model.error();
  return Error{error.kind,
               fmt::format("visual '{}': {}", visual.name,
                           Error{error.kind, error.message, error.loc}.to_string()),
               visual.loc, error.hint};
}

}  // namespace

Result<std::vector<LoadedModel>> load_visual_files(const Scene& scene) {
  std::vector<const VisualOptions*> first;  // visual of each file
  for (const VisualOptions& visual : scene.visuals) {
    const bool is_known = std::any_of(first.begin(), first.end(), [&](const VisualOptions* other) {
      return other->file == visual.file;
    });
    if (!is_known) first.push_back(&visual);
  }
  const fs::path cache = cache_folder(kVisualCache);
  std::vector<std::optional<Result<ModelFile>>> read(first.size());
  parallel_for("model files", static_cast<int64_t>(first.size()), [&](int64_t i) {
    const auto k = static_cast<size_t>(i);
    read[k] = load(scene, *first[k], cache);
  });
  std::vector<LoadedModel> out;
  for (size_t i = 0; i < first.size(); ++i) {
    GLOAM_TRY(ModelFile model, std::move(*read[i]));
    out.push_back({first[i]->file, first[i]->file.filename().string(), std::move(model)});
  }
  return out;
}

}  // namespace gloam
