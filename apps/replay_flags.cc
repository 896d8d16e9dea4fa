#include "replay_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace gloam::cli {
namespace {

using Names = std::initializer_list<std::string_view>;

bool is_given(const CLI::App& app, std::string_view name) {
  const CLI::Option* option = app.get_option_no_throw(std::string(name));
  return option != nullptr && option->count() > 0;
}

bool any_given(const CLI::App& app, Names names) {
  return std::ranges::any_of(names, [&](std::string_view name) { return is_given(app, name); });
}

Error without_effect(std::string_view name, std::string_view why, std::string hint) {
  return {ErrorKind::kUsage, fmt::format("{} has no effect {}", name, why), {}, std::move(hint)};
}

Status refuse(const CLI::App& app, Names names, std::string_view why, const std::string& hint) {
  for (const std::string_view name : names)
    if (is_given(app, name)) return without_effect(name, why, hint);
  return {};
}

/// A verification steps the runs as they were: of all options it takes the folder alone.
Status refuse_beside_verify(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    const bool is_taken = name == "LOG" || name == "--verify" || name == "--folder";
    if (option->count() > 0 && !is_taken)
      return without_effect(name, "with --verify, which replays all runs unchanged",
                            "use only one of them");
  }
  return {};
}

}  // namespace

Status refuse_void_flags(const CLI::App& app) {
  if (is_given(app, "--verify")) return refuse_beside_verify(app);
  const bool is_live = any_given(app, {"--view", "--ros2", "--zmq", "--foxglove"});
  if (is_live) {
    GLOAM_TRY_STATUS(refuse(
        app, {"--out", "--log", "--overwrite", "--output", "--variants", "--randomize", "--restep"},
        "in a live replay", "remove --view, --ros2, --zmq and --foxglove to record the replay"));
  } else {
    GLOAM_TRY_STATUS(refuse(app, {"--loop", "--paused", "--port", "--speed"},
                            "in a recorded replay",
                            "use --view, --ros2, --zmq or --foxglove for a live replay"));
    if (!is_given(app, "--out"))
      GLOAM_TRY_STATUS(refuse(app, {"--camera", "--output", "--variants"}, "without --out",
                              "set the results folder with --out"));
    if (!any_given(app, {"--out", "--log"}))
      GLOAM_TRY_STATUS(refuse(app, {"--overwrite"}, "without --out or --log", ""));
  }
  if (!is_given(app, "--variants"))
    GLOAM_TRY_STATUS(refuse(app, {"--randomize"}, "without --variants",
                            "to apply a file with [[randomize]] tables once, use --overlay"));
  if (!any_given(app, {"--overlay", "--randomize"}))
    GLOAM_TRY_STATUS(refuse(
        app, {"--seed"}, "without --overlay or --randomize",
        "it only seeds the [[randomize]] tables of these files; the run keeps its own seed"));
  return {};
}

}  // namespace gloam::cli
