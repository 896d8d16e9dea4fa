#include "record/run_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/nesting.h"
#include "base/text.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

Error folder_error(const fs::path& folder, ErrorKind kind, std::string message, std::string hint) {
  return {kind, std::move(message), {folder.string(), 0, 0}, std::move(hint)};
}

/// Removes what an earlier recording says it wrote. Its summary is a file like any other: names
/// that are not plain names are not trusted.
Status remove_recording(const fs::path& folder) {
  GLOAM_TRY(const std::string text, read_text_file(folder / kSummaryName, 16 << 20));
  const nlohmann::json summary = parse_bounded<nlohmann::json>(text);
  const auto entries = summary.is_object() ? summary.find("entries") : summary.end();
  if (!summary.is_object() || summary.value("format", nlohmann::json()) != "gloam-run 1" ||
      entries == summary.end() || !entries->is_array())
    return folder_error(folder, ErrorKind::kUsage,
                        fmt::format("contains a {} that Gloam did not write", kSummaryName),
                        "choose another folder with --out");
  for (const nlohmann::json& entry : *entries) {
    if (!entry.is_string()) continue;
    const std::string name = entry.get<std::string>();
    if (name.empty() || name != safe_file_name(name)) continue;
    std::error_code code;
    const fs::path path = folder / name;
    if (fs::is_symlink(fs::symlink_status(path, code))) continue;
    fs::remove_all(path, code);
    if (code)
      return folder_error(path, ErrorKind::kIo,
                          fmt::format("cannot remove the earlier recording: {}", code.message()),
                          "check its permissions");
  }
  return {};
}

}  // namespace

Status prepare_run_folder(const fs::path& folder, bool overwrite) {
  GLOAM_TRY_STATUS(make_folder(folder));
  std::error_code code;
  const bool empty = fs::is_empty(folder, code);
  if (code)
    return folder_error(folder, ErrorKind::kIo, fmt::format("cannot be read: {}", code.message()),
                        "check its permissions");
  if (empty) return {};
  const bool recording = fs::exists(folder / kSummaryName, code);
  if (recording && overwrite) return remove_recording(folder);
  return folder_error(
      folder, ErrorKind::kUsage,
      recording ? "already contains a recording" : "is not empty and contains no Gloam recording",
      recording ? "choose another folder with --out, or replace it with --overwrite"
                : "choose another folder with --out");
}

fs::path next_run_folder(const fs::path& base, const std::string& name) {
  for (int i = 1;; ++i) {
    fs::path path = base / fmt::format("{}-{:03}", safe_file_name(name), i);
    std::error_code code;
    if (!fs::exists(fs::symlink_status(path, code))) return path;
  }
}

std::string safe_file_name(const std::string& text) {
  std::string out;
  for (const char c : text.substr(0, 100)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '.' || c == '-' || c == '_';
    out += plain ? c : '_';
  }
  if (out.empty()) return "unnamed";
  if (out[0] == '.') out[0] = '_';
  return out;
}

FileNames::FileNames(std::initializer_list<const char*> taken) {
  for (const char* name : taken) taken_.insert(lower_case(name));
}

std::string FileNames::take(const std::string& text, const std::vector<std::string>& suffixes) {
  const std::string safe = safe_file_name(text);
  std::string name = safe;
  const auto is_taken = [&](const std::string& suffix) {
    return taken_.contains(lower_case(name + suffix));
  };
  for (int i = 2; std::any_of(suffixes.begin(), suffixes.end(), is_taken); ++i)
    name = fmt::format("{}_{}", safe, i);
  for (const std::string& suffix : suffixes) taken_.insert(lower_case(name + suffix));
  return name;
}

}  // namespace gloam
