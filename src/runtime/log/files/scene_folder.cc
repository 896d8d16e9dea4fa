#include "runtime/log/files/scene_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "base/cache.h"
#include "base/files.h"
#include "base/hash.h"
#include "runtime/log/files/staged_files.h"
#include "scene/files/model_path.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

constexpr int kMostEntries = 20000;  // of folders that are searched for a moved file
constexpr int kMaxFolderDepth = 8;   // levels below a folder that is searched
constexpr uint64_t kSceneMagic = 0x313043534D4F4C47ull;  // "GLOMSC01"
constexpr uint64_t kLargestFile = uint64_t{1} << 30;     // as McapLimits::attachment_bytes

using Bytes8 = std::vector<uint8_t>;

fs::path remembered_entry(const RunText& text) {
  uint64_t key = hash_bytes(text.toml.data(), text.toml.size());
  for (const RunText::File& file : text.files) {
    key = hash_bytes(file.path.data(), file.path.size(), key);
    key = hash_bytes(&file.hash, sizeof(file.hash), key);
  }
  return cache_folder(kSceneCache) / cache_entry_name(kSceneCache, key);
}

fs::path remembered_folder(const RunText& text) {
  const auto entry = read_file(remembered_entry(text), 1 << 16);
  if (!entry.ok()) return {};
  const std::span<const uint8_t> path = unseal_cache_entry(kSceneMagic, *entry);
  return std::string(path.begin(), path.end());
}

class SceneFinder {
 public:
  SceneFinder(const RunText& text, const McapReader& log, const fs::path& folder)
      : text_(text), log_(log), is_given_(!folder.empty()) {
    const fs::path beside = absolute_path(log.name(), "").parent_path();
    if (!folder.empty()) {
      places_ = {absolute_path(folder, "")};
    } else if (text.format < 2) {
      places_ = {text.folder};
    } else {
      if (!text.folder.empty()) places_ = {absolute_path(text.folder, beside)};
      const fs::path remembered = remembered_folder(text);
      for (const fs::path& place : {beside, remembered, absolute_path(".", "")})
        if (!place.empty() && std::ranges::find(places_, place) == places_.end())
          places_.push_back(place);
    }
    for (const McapAttachmentIndex& attachment : log.attachments())
      embedded_.emplace(attachment.name, &attachment);
  }

  Result<SceneFolder> find() {
    const bool needs_access = text_.has_root || !text_.packages.empty();
    for (const fs::path& place : places_)
      if (!needs_access && in_place(place) == text_.files.size()) return SceneFolder{place};
    if (text_.files.empty()) return SceneFolder{places_.front()};
    GLOAM_TRY(std::optional<SceneFolder> staged, stage());
    if (staged) return *std::move(staged);
    return most_complete();
  }

 private:
  size_t in_place(const fs::path& place) const {
    return static_cast<size_t>(
        std::ranges::count_if(text_.files, [&](const auto& f) { return is_in_place(place, f); }));
  }

  // The folder with most of the files, whatever is in them.
  Result<SceneFolder> most_complete() const {
    size_t most = 0;
    fs::path best;
    for (const fs::path& place : places_) {
      std::error_code code;
      const auto here = static_cast<size_t>(std::ranges::count_if(
          text_.files, [&](const auto& f) { return fs::exists(path_in(place, f), code); }));
      if (here > most) best = place;
      most = std::max(most, here);
    }
    if (most > 0) return SceneFolder{best};
    std::string searched;
    for (const fs::path& place : places_)
      searched += (searched.empty() ? "" : ", ") + place.string();
    return Error{
        ErrorKind::kInput,
        fmt::format(
            "cannot find the files of the logged scene: '{}'{}; searched: {}",
            text_.files.front().path,
            text_.files.size() > 1 ? fmt::format(" and {} more", text_.files.size() - 1) : "",
            searched),
        {log_.name(), 0, 0},
        "give the scene's folder with --folder, or record with --embed"};
  }

  // Puts the files together from wherever they are; nothing if one is missing.
  Result<std::optional<SceneFolder>> stage() {
    for (const RunText::File& file : text_.files)
      if (fs::path(file.path).is_absolute()) return std::optional<SceneFolder>();  // format 1
    GLOAM_TRY(const StagedFiles staged, StagedFiles::make(text_));
    for (const RunText::File& file : text_.files) {
      GLOAM_TRY(const std::optional<Bytes8> bytes, find_content(file));
      if (!bytes) return std::optional<SceneFolder>();
      GLOAM_TRY_STATUS(staged.add(file, *bytes));
    }
    return std::optional(staged.folder(text_));
  }

  Result<std::optional<Bytes8>> find_content(const RunText::File& file) {
    for (const fs::path& place : places_)
      if (auto bytes = content(path_in(place, file), file.hash)) return bytes;
    GLOAM_TRY(auto embedded, read_embedded(file));
    if (embedded) return std::optional(std::move(embedded));
    if (is_changed(file)) return std::optional<Bytes8>();
    if (!is_listed_) list_files();
    const auto [first, last] = by_name_.equal_range(fs::path(file.path).filename().string());
    for (auto it = first; it != last; ++it)
      if (auto bytes = content(it->second, file.hash)) return bytes;
    return std::optional<Bytes8>();
  }

  // A file that is where it should be, with other content, is told of; no copy of what it was is
  // taken in its place.
  bool is_changed(const RunText::File& file) const {
    return std::ranges::any_of(places_, [&file](const fs::path& place) {
      std::error_code code;
      return fs::exists(path_in(place, file), code);
    });
  }

  static std::optional<Bytes8> content(const fs::path& path, uint64_t hash) {
    auto bytes = read_file(path, kLargestFile);
    if (!bytes.ok() || hash_bytes(bytes->data(), bytes->size()) != hash) return {};
    return *std::move(bytes);
  }

  Result<std::optional<Bytes8>> read_embedded(const RunText::File& file) const {
    auto found = embedded_.find(file.path);
    if (found == embedded_.end())  // format 1 has absolute names
      found = embedded_.find(path_in(text_.folder, file).string());
    if (found == embedded_.end()) return std::optional<Bytes8>();
    GLOAM_TRY(McapAttachment attachment, log_.read_attachment(*found->second));
    if (hash_bytes(attachment.data.data(), attachment.data.size()) != file.hash)
      return Error{
          ErrorKind::kInput,
          fmt::format(
              "the embedded file '{:.80}' differs from the file that the log was recorded with",
              file.path),
          {log_.name(), 0, 0}};
    return std::optional(std::move(attachment.data));
  }

  // Files below the searched folders by their names, up to a limit.
  void list_files() {
    is_listed_ = true;
    int entries = 0;
    std::vector<fs::path> folders = places_;
    // Gloam's own robots need not lie near the scene that uses them.
    if (fs::path own = catalogue_folder(); !own.empty() && !is_given_)
      folders.insert(folders.begin(), std::move(own));
    for (const fs::path& place : folders) {
      if (!is_given_ && holds_homes(place)) continue;  // unasked, no whole disk or home is searched
      std::error_code code;
      fs::recursive_directory_iterator it(place, fs::directory_options::skip_permission_denied,
                                          code);
      for (const fs::recursive_directory_iterator end; !code && it != end; it.increment(code)) {
        if (++entries > kMostEntries) return;
        if (it.depth() >= kMaxFolderDepth) it.disable_recursion_pending();
        std::error_code other;
        if (it->is_regular_file(other))
          by_name_.emplace(it->path().filename().string(), it->path());
      }
    }
  }

  const RunText& text_;
  const McapReader& log_;
  std::vector<fs::path> places_;
  std::map<std::string, const McapAttachmentIndex*> embedded_;
  std::multimap<std::string, fs::path> by_name_;
  const bool is_given_;  // the user names the folder
  bool is_listed_ = false;
};

}  // namespace

void remember_scene_folder(const DescribedRun& run) {
  const std::string folder = run.folder.string();
  std::vector<uint8_t> entry;
  begin_cache_entry(&entry);
  entry.insert(entry.end(), folder.begin(), folder.end());
  seal_cache_entry(kSceneMagic, &entry);
  keep_in_cache(remembered_entry(run.text), entry);
}

Result<SceneFolder> find_scene_folder(const RunText& text, const McapReader& log,
                                      const fs::path& folder) {
  return SceneFinder(text, log, folder).find();
}

}  // namespace gloam
