#pragma once
// Folder of a run's results. Nobody's files are ever destroyed unasked.

#include <filesystem>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Name of the file that marks a folder as a recording and says what is in it.
inline constexpr const char* kSummaryName = "summary.json";

/// Makes `folder` ready to be written: it must be missing, empty, or, with `overwrite`, an earlier
/// recording, whose own files (listed in its summary) are removed; anything else in it stays.
/// Errors: it holds other things, no permission.
Status prepare_run_folder(const std::filesystem::path& folder, bool overwrite);

/// `base`/NAME-001, or the first number that does not exist yet.
std::filesystem::path next_run_folder(const std::filesystem::path& base, const std::string& name);

/// A file name made from any text: letters, digits, '.', '-' and '_' stay, the rest becomes '_';
/// never empty, hidden, or "..".
std::string safe_file_name(const std::string& text);

/// Hands out names of files in one folder, none twice: nor two that differ in case alone, which
/// are one file to the file systems of Windows and macOS.
class FileNames {
 public:
  explicit FileNames(std::initializer_list<const char*> taken = {});
  /// safe_file_name(text), with a number where that name or, with one of the `suffixes` behind it,
  /// its file is taken.
  std::string take(const std::string& text, const std::vector<std::string>& suffixes = {""});

 private:
  std::set<std::string> taken_;  // in lower case
};

}  // namespace gloam
