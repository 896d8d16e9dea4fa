#pragma once
// Allowed places of a model's files. Models come from strangers: a model must not make Gloam read
// /etc/passwd or a private key next to the downloads folder.

#include <filesystem>
#include <string>
#include <vector>

#include "gloam/scene.h"

namespace gloam {

/// Limit on one file of a model in XML or TOML [bytes].
inline constexpr uint64_t kLargestModelText = uint64_t{64} << 20;

/// True if the name is that of an archive or a binary model, which is not read.
bool is_container(const std::filesystem::path& path);

/// Refuses what is by its name a mesh, where a model is wanted at `loc`; `as_written`: its name
/// there.
Status refuse_mesh(const std::filesystem::path& path, const std::string& as_written,
                   const SourceLoc& loc);

/// The folders one model may read from. All canonical.
struct ModelRoot {
  std::filesystem::path folder;  ///< as MuJoCo spells paths below it: absolute, not canonical
  std::filesystem::path canonical;
  std::filesystem::path linked;  ///< files reached through a symbolic link must lie below this one
  /// The model lies directly in a home folder or in "/": hidden files stay out of reach, and of "/"
  /// only the files beside the model are read.
  bool is_wide = false;
};

/// Root of the model (or scene) `file`: FileAccess::root if given, its own folder if strict, else
/// the nearest of its folder and four more levels up that holds package.xml, else the highest of
/// them; never climbs to "/", a home folder, or past a symbolic link. Errors: the file is not
/// inside the root that the user gave, nor in the catalogue_folder().
Result<ModelRoot> find_model_root(const std::filesystem::path& file, const FileAccess& access);

/// Folder of Gloam's own robots, gloam_home()/assets/robots, which every scene may read; empty
/// where it is not found.
std::filesystem::path catalogue_folder();

/// Empty when `path` (absolute) may be read under one of `roots`; else why not, as half a sentence
/// that follows the file's name.
std::string why_not_readable(const std::filesystem::path& path,
                             const std::vector<ModelRoot>& roots);

/// Folder that package://`name`/ stands for: FileAccess::packages, else the nearest folder above
/// `file` whose package.xml says so or that is called `name`. Empty when there is none.
std::filesystem::path find_package(const std::string& name, const std::filesystem::path& file,
                                   const FileAccess& access);

/// True for "/", for home folders and for folders above one: the names below such a folder tell
/// whose machine it is.
bool holds_homes(const std::filesystem::path& folder);

/// The file's folder and those above it that may be its model's root, nearest first: at most four
/// levels up, never "/" or a home folder unless the file lies there, nor past a symbolic link.
std::vector<std::filesystem::path> candidate_roots(const std::filesystem::path& file);

/// `path` made absolute against `base`, without "." and "..", links untouched. An absolute `path`
/// stays.
std::filesystem::path absolute_path(const std::filesystem::path& path,
                                    const std::filesystem::path& base);

/// Error text when a name found in a file is no plain path ("http://…", a NUL, far too long), else
/// "".
std::string why_not_a_path(std::string_view name);

}  // namespace gloam
