#pragma once
// Entries of the cache, written while the program goes on.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gloam {

/// Makes an entry (begin_cache_entry), which may stay empty, and keeps it in the file `path`, on a
/// thread of its own: one entry after another, each when the program has had two seconds to go on;
/// its end waits for the last. `held` = bytes that `make` keeps in memory until then. Where more
/// than 1 GiB waits already, this call writes the entry. As keep_in_cache, it has no errors.
void keep_in_cache_later(const std::filesystem::path& path, uint64_t magic, uint64_t held,
                         std::function<std::vector<uint8_t>()> make);

/// Keeps an entry that is made, but not sealed, in the same way.
void keep_in_cache_later(const std::filesystem::path& path, uint64_t magic,
                         std::vector<uint8_t> entry);

/// Waits for the entries that are not written yet. For tests and timings.
void finish_cache_writes();

}  // namespace gloam
