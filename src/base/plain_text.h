#pragma once
// Text files as other programs write them: byte-order marks, UTF-16, Windows-1252 (Latin-1), line
// ends of old Macs, NULs at the end. Every reader of text takes its bytes through here.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gloam/result.h"

namespace gloam {

/// The text without a mark at its front, as UTF-8, with line feeds where lone carriage returns
/// ended its lines (CR LF stays, every reader knows it), without NULs and Ctrl-Z at its end. Bytes
/// that are no part of UTF-8 are taken for characters of Windows-1252. Empty: it is so already.
/// Error: UTF-16 that is cut off.
Result<std::optional<std::string>> plain_text(std::string_view bytes, const std::string& file);

/// read_text_file, made plain. Errors: likewise; a Git LFS pointer.
Result<std::string> read_plain_text(const std::filesystem::path& path,
                                    uint64_t max_size = uint64_t{64} << 20);

/// Pointer that Git LFS leaves in the place of a file that was not fetched.
bool is_lfs_pointer(std::string_view bytes);
/// The error that such a file is.
Error lfs_pointer_error(const std::string& file);

}  // namespace gloam
