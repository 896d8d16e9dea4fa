#pragma once
// Names of files as programs on other systems write them: with '\' between folders, or as a URI in
// which spaces and other characters are written as %20.

#include <string>
#include <string_view>
#include <vector>

namespace gloam {

/// Text whose percent-encoded characters (%20) are decoded; a '%' without two hexadecimal digits
/// behind it stays.
std::string decode_percent(std::string_view text);

/// `name` with '/' for every '\'.
std::string with_slashes(std::string_view name);

/// The names that `name` may stand for, the most literal one first: itself, with '/' for '\', with
/// its percent signs decoded, both. A file that exists under an earlier one is meant.
std::vector<std::string> path_readings(std::string_view name);

/// The file's name alone where `name` is an absolute path or has a drive, with '/' for '\': such a
/// path is that of the machine that wrote it, and the file may lie beside the one that names it.
std::string without_foreign_folder(std::string_view name);

}  // namespace gloam
