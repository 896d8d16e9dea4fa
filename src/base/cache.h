#pragma once
// Cache on disk, so that a second start is faster: a folder for each kind below cache_folder(), an
// entry a file there, named by a hash. Several processes may use one cache: an entry is written
// aside and renamed, carries the hash of its content, and may vanish at any time. All kinds
// together stay within cache_limit(). Only files that are entries by name and first bytes are ever
// counted or removed: someone's files, which a mistaken GLOAM_CACHE may lead to, are left alone.
// gloam/program.h lists and clears.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gloam/result.h"

namespace gloam {

/// Format of one kind of entries.
struct CacheFormat {
  std::string_view kind;    ///< and its folder's name
  std::string_view ending;  ///< of its files
  std::string_view what;    ///< for people
};
inline constexpr CacheFormat kModelCache{"models", ".world",
                                         "compiled models with their hulls and textures"};
inline constexpr CacheFormat kVisualCache{"visuals", ".model", "model files of [[visual]]s"};
inline constexpr CacheFormat kBvhCache{"bvhs", ".bvh",
                                       "ray-tracing trees of large meshes, for GPUs"};
inline constexpr CacheFormat kLightCache{"light", ".light",
                                         "light of the interactive tier's first images"};
inline constexpr CacheFormat kPatternCache{"patterns", ".pattern",
                                           "procedural materials, baked onto surfaces"};
inline constexpr CacheFormat kHullCache{"hulls", ".hulls", "convex parts of meshes"};
inline constexpr CacheFormat kSceneCache{"scenes", ".scene", "folders of logged scenes"};

/// First bytes of every entry: those of its format's number.
inline constexpr std::string_view kCacheMagic = "GLOM";

/// An entry is a head, by which it is known to be whole, and what the format has to say. First
/// room for the head, then what is to be kept behind it, then the head itself.
void begin_cache_entry(std::vector<uint8_t>* entry);
void seal_cache_entry(uint64_t magic, std::vector<uint8_t>* entry);
/// Content behind the head; nothing if the entry is damaged or of another format.
std::span<const uint8_t> unseal_cache_entry(uint64_t magic, std::span<const uint8_t> entry);

/// Hash of large data, by all threads.
uint64_t hash_large(std::span<const std::byte> bytes);

/// Per-user cache folder ($XDG_CACHE_HOME/gloam or ~/.cache/gloam); $GLOAM_CACHE overrides.
std::filesystem::path cache_folder();
std::filesystem::path cache_folder(const CacheFormat& format);

/// Name of the entry's file.
std::string cache_entry_name(const CacheFormat& format, uint64_t key);

/// Keeps `bytes`, which begin with kCacheMagic, in the file `entry`, then drops what was used
/// longest ago. A cache that cannot be written is no error, and what is larger than all may be is
/// not kept.
void keep_in_cache(const std::filesystem::path& entry, std::span<const uint8_t> bytes);

/// The entry was used now: it is dropped late.
void mark_cache_use(const std::filesystem::path& entry);

/// Removes the entries that were used longest ago until at most `limit` bytes are left.
void trim_cache(uint64_t limit);

}  // namespace gloam
