#pragma once
// Reading and writing whole files, with errors that name a remedy.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/program.h"
#include "gloam/result.h"

namespace gloam {

/// Reads a regular file of at most `max_size` bytes. Errors: missing, a folder, no permission, too
/// large.
Result<std::vector<uint8_t>> read_file(const std::filesystem::path& path,
                                       uint64_t max_size = uint64_t{1} << 30);
Result<std::string> read_text_file(const std::filesystem::path& path,
                                   uint64_t max_size = uint64_t{64} << 20);

/// ".toml" of "scene.TOML".
std::string lower_extension(const std::filesystem::path& path);

/// Ending of a file's name while it is written: its name, a point, hexadecimal digits and this.
inline constexpr std::string_view kTemporaryEnding = ".tmp";

/// Writes to a temporary file beside `path` and renames it: readers see the old file or the new
/// one, whole, however many write at once.
Status write_file_atomic(const std::filesystem::path& path, std::span<const uint8_t> bytes);
Status write_text_file_atomic(const std::filesystem::path& path, const std::string& text);

/// Creates a folder and its parents.
Status make_folder(const std::filesystem::path& path);

}  // namespace gloam
