// gloam::replay_variants: one logged run under many skies, each drawn by a seed of its own.

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/hash.h"
#include "base/nesting.h"
#include "gloam/log_replay.h"

namespace gloam {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kListName = "variants.json";

/// Hash of everything that decides what a variant of a seed is.
Result<std::string> fingerprint(const VariantRequest& request) {
  const LogReplay& replay = request.replay;
  std::string all = fmt::format("{} {} {} {}x{} {}", replay.run, static_cast<int>(replay.motion),
                                replay.request.duration, replay.request.width,
                                replay.request.height, fs::absolute(replay.log).string());
  std::error_code code;
  all += fmt::format(" {}", fs::file_size(replay.log, code));
  for (const auto& [path, value] : replay.settings) all += fmt::format(" {}={}", path, value);
  for (const std::string& output : replay.outputs) all += " " + output;
  for (const std::string& camera : replay.request.cameras) all += " " + camera;
  std::vector<fs::path> texts = replay.overlays;
  texts.push_back(request.randomize);
  for (const fs::path& path : texts) {
    GLOAM_TRY(const std::vector<uint8_t> text, read_file(path));
    all.append(text.begin(), text.end());
  }
  return hash_to_hex(hash_bytes(all.data(), all.size()));
}

bool is_finished(const fs::path& folder) {
  const auto text = read_text_file(folder / "summary.json");
  if (!text.ok()) return false;
  const Json summary = parse_bounded<Json>(*text);
  return summary.is_object() && summary.value("state", "") == "finished" &&
         summary.value("exit_reason", "") == "completed";
}

/// Error: the folder holds variants of another request.
Status check_list(const fs::path& list, const std::string& request) {
  std::error_code code;
  if (!fs::exists(list, code)) return {};
  GLOAM_TRY(const std::string text, read_text_file(list));
  const Json json = parse_bounded<Json>(text);
  if (json.is_object() && json.value("request", "") == request) return {};
  return Error{
      ErrorKind::kUsage,
      fmt::format("{} lists variants of another log, scene file or settings", list.string()),
      {},
      "choose another folder with --out, or replace it with --overwrite"};
}

Status write_list(const fs::path& folder, const std::string& request,
                  const std::vector<ReplayVariant>& variants) {
  Json rows = Json::array();
  for (const ReplayVariant& variant : variants)
    rows.push_back({{"seed", variant.seed}, {"folder", variant.out.filename().string()}});
  const std::string text = Json{{"request", request}, {"variants", std::move(rows)}}.dump(2) + "\n";
  return write_file_atomic(folder / kListName,
                           {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace

Result<std::vector<ReplayVariant>> replay_variants(const VariantRequest& request,
                                                   const ProgressCallback& progress) {
  const fs::path& folder = request.replay.request.out;
  if (folder.empty())
    return Error{
        ErrorKind::kUsage, "variants require a results folder", {}, "set it with --out FOLDER"};
  if (request.count < 1)
    return Error{ErrorKind::kUsage, "the number of variants must be at least 1"};
  GLOAM_TRY(const std::string print, fingerprint(request));
  if (!request.replay.request.overwrite) GLOAM_TRY_STATUS(check_list(folder / kListName, print));
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return Error{ErrorKind::kIo, fmt::format("{}: {}", folder.string(), code.message())};
  const auto start = std::chrono::steady_clock::now();
  std::vector<ReplayVariant> variants;
  for (int64_t i = 0; i < request.count; ++i) {
    ReplayVariant variant{request.first_seed + static_cast<uint64_t>(i),
                          folder / fmt::format("{:04}", i)};
    variant.was_done = !request.replay.request.overwrite && is_finished(variant.out);
    if (!variant.was_done) {
      LogReplay replay = request.replay;
      replay.overlays.push_back(request.randomize);
      replay.draw_seed = variant.seed;
      replay.request.out = variant.out;
      replay.request.overwrite = true;  // one that was stopped on its way
      const auto tell = [&](const Progress& now) {
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        return !progress ||
               progress({fmt::format("variant {} of {}: {}", i + 1, request.count, now.what),
                         (static_cast<double>(i) + now.done) / static_cast<double>(request.count),
                         wall.count()});
      };
      GLOAM_TRY(const RunReport report, replay_log(replay, tell));
      GLOAM_TRY_STATUS(report.status);
    }
    variants.push_back(std::move(variant));
    GLOAM_TRY_STATUS(write_list(folder, print, variants));
  }
  return variants;
}

}  // namespace gloam
