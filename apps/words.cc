#include "words.h"

#include <fmt/format.h>

#include <algorithm>

#include "gloam/program.h"

namespace gloam::cli {
namespace {

// Commands of the start script (gloam in the source tree).
const std::vector<std::pair<std::string, std::string>> kScriptCommands = {
    {"setup", "Install missing packages and build the program"},
    {"test", "Run the tests"},
    {"bench", "Run the benchmarks; bench nav, bench slam, bench real: planners, SLAM, images"},
    {"navigate", "Run a scene with its planner"},
    {"map", "Make a topological map from a log"},
    {"slam", "Install SLAM methods, list them, make vocabularies"},
    {"match", "Solve the camera and exposure of a photograph in a scene"},
    {"real", "Render views for a comparison with photographs, convert networks"},
    {"mitsuba", "Compare the path tier with Mitsuba 3"},
    {"gallery", "Render the images of docs/gallery"},
    {"docs", "Build the documentation site in build/site"},
    {"pack", "Bundle the program for a machine with an NVIDIA GPU"},
    {"python", "Start Python with the gloam module"},
    {"wheel", "Build a Python wheel that contains all libraries it needs"},
    {"doctor", "Report missing requirements of this machine and how to fix them"}};

}  // namespace

std::vector<std::pair<std::string, std::string>> commands(const CLI::App& root) {
  auto list = kScriptCommands;
  for (const CLI::App* sub : root.get_subcommands({}))
    list.emplace_back(sub->get_name(), sub->get_description());
  return list;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

Error explain(const CLI::App& root, const std::string& word, const CLI::ParseError& error) {
  std::vector<std::string> names = {"--help"};  // for "gloam help"
  for (const auto& [name, text] : commands(root)) names.push_back(name);
  if (!word.empty() && std::ranges::find(names, word) == names.end())
    return {ErrorKind::kUsage,
            fmt::format("unknown command '{}'", word),
            {},
            suggest_name(word, names)};
  std::vector<std::string> options = option_names(root);
  for (const CLI::App* sub : root.get_subcommands())
    for (const std::string& name : option_names(*sub))
      if (std::ranges::find(options, name) == options.end()) options.push_back(name);
  for (const std::string& extra : root.remaining(true)) {
    const std::string name = extra.substr(0, extra.find('='));
    if (!name.starts_with('-') || std::ranges::find(options, name) != options.end()) continue;
    std::string hint = suggest_name(name, options);
    if (hint.empty()) hint = "run with --help";
    return {ErrorKind::kUsage, fmt::format("unknown option '{}'", name), {}, hint};
  }
  return {ErrorKind::kUsage, error.what(), {}, "run with --help"};
}

}  // namespace gloam::cli
