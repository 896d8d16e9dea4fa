#pragma once
// PortablePaths: the names that a log gives to the files of a scene. They are relative to the
// scene's folder and hold nothing of the machine, so that a log can be replayed elsewhere.

#include <filesystem>
#include <string>
#include <vector>

namespace gloam {

class PortablePaths {
 public:
  /// `folder` is the scene's, `files` are all that will be named and `packages` are folders that
  /// were given for package://NAME; all absolute.
  PortablePaths(std::filesystem::path folder, const std::vector<std::filesystem::path>& files,
                const std::vector<std::filesystem::path>& packages);

  /// "go1/go1.xml" or "../shared/sky.hdr", as seen from the scene's folder. A path that leads
  /// through "/" or a home folder becomes "_outside/0/arm.xml", below a folder that stands for the
  /// root of its model.
  std::string name(const std::filesystem::path& path) const;

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> outside_;  // roots, an ancestor before its descendants
};

/// `path` as seen from `folder`; empty where the way leads through "/" or a home folder.
std::filesystem::path portable_relative(const std::filesystem::path& path,
                                        const std::filesystem::path& folder);

/// The deepest folder that holds all of `files`; empty if that is "/" or a home folder.
std::filesystem::path common_folder(const std::vector<std::filesystem::path>& files);

}  // namespace gloam
