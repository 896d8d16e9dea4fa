// gloam check: compares models with stock MuJoCo and with their own exports.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <stdlib.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "command.h"
#include "gloam/model_tools.h"
#include "interrupt.h"
#include "json_text.h"
#include "print.h"

namespace gloam::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct CheckCommand {
  std::vector<std::string> files;
  FileAccess access;
  std::vector<std::string> packages;
};

/// A folder for exports that vanishes with it.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "gloam_check_XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ScratchFolder() { clear(); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  /// Empty when it could not be made.
  const fs::path& path() const { return path_; }
  void clear() const {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }

 private:
  fs::path path_;
};

std::string of_stock(const ModelCheck& check) {
  if (!check.stock_refusal) return "";
  if (check.stock_refusal->empty()) return "; stock MuJoCo loads it";
  return fmt::format("; stock MuJoCo does not load it: {}", *check.stock_refusal);
}

std::string verdict(const ModelCheck& check) {
  if (!check.status.ok()) return check.status.error().to_string() + of_stock(check);
  std::string text;
  const auto add = [&](const char* whom, const std::vector<std::string>& differing) {
    text += differing.empty()
                ? fmt::format("; equal to {}", whom)
                : fmt::format("; differs from {} in {}", whom, fmt::join(differing, ", "));
  };
  if (check.stock_refusal == "")
    add("stock MuJoCo's model", check.unlike_stock);
  else
    text += of_stock(check);
  add("its export", check.unlike_export);
  if (!check.export_reason.empty())
    text += "; MJCF cannot express this scene exactly: " + check.export_reason;
  return text.substr(2);
}

void print_line(const std::string& file, const ModelCheck& check, double seconds) {
  if (!check.status.ok()) return say("{}: FAILED: {}\n", file, verdict(check));
  say("{}: {} bodies, {} joints, {} geoms: {}{} ({} fields, export {:.2f} MB, {:.2f} s)\n", file,
      check.bodies, check.joints, check.geoms, check.passed() ? "" : "FAILED: ", verdict(check),
      check.compared, static_cast<double>(check.export_bytes) / 1e6, seconds);
}

Json as_json(const std::string& file, const ModelCheck& check, double seconds) {
  Json json = {{"file", file},
               {"passed", check.passed()},
               {"error", check.status.ok() ? "" : check.status.error().to_string()},
               {"bodies", check.bodies},
               {"joints", check.joints},
               {"geoms", check.geoms},
               {"fields_compared", check.compared},
               {"stock_loads", nullptr},
               {"differs_from_stock", check.unlike_stock},
               {"differs_from_export", check.unlike_export},
               {"export_error", check.export_reason},
               {"export_bytes", check.export_bytes},
               {"seconds", seconds}};
  if (check.stock_refusal) {
    json["stock_loads"] = check.stock_refusal->empty();
    json["stock_error"] = *check.stock_refusal;
  }
  return json;
}

int check(const CheckCommand& command, const Globals& globals) {
  FileAccess access = command.access;
  if (const Status status = apply_packages(access, command.packages); !status.ok())
    return fail(status.error());
  const ScratchFolder scratch;
  if (scratch.path().empty())
    return fail({ErrorKind::kIo,
                 "cannot create a temporary folder for exports",
                 {},
                 "set TMPDIR to a writable folder"});
  size_t passed = 0;
  Json models = Json::array();
  for (const std::string& file : command.files) {
    const auto start = std::chrono::steady_clock::now();
    const ModelCheck check = [&] {
      const EndOnInterrupt watched([&] { scratch.clear(); });
      return check_model(file, access, scratch.path());
    }();
    scratch.clear();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    passed += check.passed() ? 1 : 0;
    if (globals.json)
      models.push_back(as_json(file, check, took.count()));
    else
      print_line(file, check, took.count());
    std::fflush(stdout);
  }
  const size_t count = command.files.size();
  if (globals.json) {
    const Json json = {{"models", models}, {"passed", passed}, {"failed", count - passed}};
    put_json(json);
  } else if (count > 1) {
    say("{} of {} passed\n", passed, count);
  }
  return passed == count ? 0 : 1;
}

}  // namespace

void add_check(CLI::App& app, Globals& globals, Action& action) {
  CLI::App* sub =
      app.add_subcommand("check", "Compare models with stock MuJoCo and with their own exports");
  auto command = std::make_shared<CheckCommand>();
  sub->add_option("FILE", command->files, "Scenes or models")->required();
  add_access_options(*sub, command->access, command->packages);
  sub->footer(
      "Compares all sizes, options and arrays of mjModel bit for bit. The exit code is 1 if "
      "anything differs or a file\ndoes not load. In that case stock MuJoCo tries to load it too, "
      "and may read any file that it refers to.\nExamples:\n  gloam check robot.urdf --package "
      "my_robot=.\n  gloam check robots/*.xml --json");
  sub->callback([&globals, &action, command] {
    action = [&globals, command] { return check(*command, globals); };
  });
}

}  // namespace gloam::cli
