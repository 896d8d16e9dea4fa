#pragma once
// Where a run's results go. Nobody's files are ever destroyed unasked.

#include <filesystem>
#include <string>

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

}  // namespace gloam
