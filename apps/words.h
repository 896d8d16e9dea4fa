#pragma once
// The words of the command line, and suggestions for misspelt ones.

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "gloam/result.h"

namespace gloam::cli {

/// Names and descriptions of all commands, including the commands of the start script, which are
/// not part of the program.
std::vector<std::pair<std::string, std::string>> commands(const CLI::App& root);
/// "--name" and "-n" of an App's own options.
std::vector<std::string> option_names(const CLI::App& app);

/// Message for an `error` of a command line whose first word is `word` ("" if there are only
/// options): with the nearest command or option where one of that name does not exist.
Error explain(const CLI::App& root, const std::string& word, const CLI::ParseError& error);

}  // namespace gloam::cli
