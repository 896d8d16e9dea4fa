#include "words.h"

#include <fmt/format.h>

#include <algorithm>

#include "gloam/program.h"

namespace gloam::cli {
namespace {

// Commands of the start script (gloam in the source tree).
const std::vector<std::pair<std::string, std::string>> kScriptCommands = {
    {"setup", "Install what is missing and build"},
    {"test", "Run the tests"},
    {"bench", "Measure against peers and limits"},
    {"mitsuba", "Judge the path tier by Mitsuba 3"},
    {"gallery", "Make the pictures of docs/gallery"},
    {"docs", "Build the documentation site in build/site"},
    {"pack", "Bundle the program for a machine with an NVIDIA card"},
    {"python", "Start Python with the module gloam"},
    {"wheel", "Make a Python wheel that carries every library it needs"},
    {"doctor", "Say what is missing on this machine and how to mend it"}};

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
            fmt::format("there is no command '{}'", word),
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
    return {ErrorKind::kUsage, fmt::format("there is no option '{}'", name), {}, hint};
  }
  return {ErrorKind::kUsage, error.what(), {}, "run with --help"};
}

}  // namespace gloam::cli
