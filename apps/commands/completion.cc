// gloam completion: shell completion scripts, made from the command tree itself.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>

#include "command.h"
#include "words.h"

namespace gloam::cli {
namespace {

std::string bash_script(const CLI::App& root) {
  std::string names, cases;
  for (const auto& [name, text] : commands(root)) names += name + " ";
  for (const CLI::App* sub : root.get_subcommands({})) {
    cases += fmt::format("    {}) words=\"{}\" ;;\n", sub->get_name(),
                         fmt::join(option_names(*sub), " "));
  }
  return fmt::format(
      "_gloam() {{\n  local words=\"\" current=${{COMP_WORDS[COMP_CWORD]}}\n"
      "  if [ \"$COMP_CWORD\" = 1 ]; then words=\"{}{}\"; else case \"${{COMP_WORDS[1]}}\" in\n{}  "
      "esac; fi\n"
      "  case \"$current\" in -*|'') COMPREPLY=($(compgen -W \"$words\" -- \"$current\")) ;; *) "
      "COMPREPLY=($(compgen -W "
      "\"$words\" -- \"$current\")) ;; esac\n"
      "  [ \"$COMP_CWORD\" -gt 1 ] && [ \"${{current#-}}\" = \"$current\" ] && "
      "COMPREPLY+=($(compgen -f -- \"$current\"))\n}}\n"
      "complete -o filenames -F _gloam gloam ./gloam\n",
      names, fmt::join(option_names(root), " "), cases);
}

std::string quoted(std::string text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c == ':' ? ' ' : c;
  }
  return out;
}

std::string zsh_script(const CLI::App& root) {
  std::string names, cases;
  for (const auto& [name, text] : commands(root))
    names += fmt::format("    '{}:{}'\n", name, quoted(text));
  for (const CLI::App* sub : root.get_subcommands({})) {
    cases += fmt::format("      {}) options=({}) ;;\n", sub->get_name(),
                         fmt::join(option_names(*sub), " "));
  }
  return fmt::format(
      "#compdef gloam\n_gloam() {{\n  local -a commands options\n  commands=(\n{}  )\n"
      "  if (( CURRENT == 2 )); then _describe command commands\n  else\n    case $words[2] in\n{} "
      "   esac\n"
      "    compadd -- $options; _files\n  fi\n}}\ncompdef _gloam gloam ./gloam\n",
      names, cases);
}

std::string fish_script(const CLI::App& root) {
  std::string text;
  for (const auto& [name, description] : commands(root)) {
    text += fmt::format("complete -c gloam -n __fish_use_subcommand -a {} -d '{}'\n", name,
                        quoted(description));
  }
  for (const CLI::App* sub : root.get_subcommands({})) {
    for (const CLI::Option* option : sub->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        text += fmt::format("complete -c gloam -n '__fish_seen_subcommand_from {}' -l {} -d '{}'\n",
                            sub->get_name(), name, quoted(option->get_description()));
      }
    }
  }
  return text;
}

}  // namespace

void add_completion(CLI::App& app, Globals& /*globals*/, Action& action) {
  CLI::App* sub = app.add_subcommand("completion", "Print a completion script for your shell");
  auto shell = std::make_shared<std::string>();
  sub->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  sub->footer("Example:\n  source <(./gloam completion bash)");
  sub->callback([&app, &action, shell] {
    action = [&app, shell] {
      const std::string text = *shell == "bash"  ? bash_script(app)
                               : *shell == "zsh" ? zsh_script(app)
                                                 : fish_script(app);
      std::fputs(text.c_str(), stdout);
      return 0;
    };
  });
}

}  // namespace gloam::cli
