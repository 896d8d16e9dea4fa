#pragma once
// Texts that MuJoCo is given instead of a URDF's own: the same robot with mesh paths that it can
// find, and a second, static one that keeps the visuals which stock loading discards.

#include <functional>
#include <string>
#include <vector>

#include "gloam/scene.h"

namespace gloam {

/// A visual's mesh, which Gloam's own readers read: what is only drawn never goes through MuJoCo's
/// mesh compiler. In the visual text a small sphere of that name stands in its place.
struct UrdfVisualMesh {
  std::string stand_in;    ///< name of the sphere
  std::string link, name;  ///< names of the link and of the visual, which may be empty
  std::filesystem::path file;
  Vec3 scale = {1, 1, 1};
  SourceLoc loc;
};

/// A mesh of physics in a format that MuJoCo does not read. The text names `copy`, an OBJ file that
/// whoever parses it has to provide.
struct UrdfMeshCopy {
  std::filesystem::path file, copy;
  SourceLoc loc;
};

struct UrdfText {
  std::string physics;  ///< empty = load the file as it is: stock MuJoCo finds all it needs
  std::string visual;   ///< visuals only, every joint fixed, nothing fused; empty = no visuals
  std::vector<UrdfVisualMesh> visual_meshes;
  std::vector<UrdfMeshCopy> copies;
  std::vector<Error> unsupported;  ///< visuals that cannot be drawn, and where
  std::vector<Error> notes;        ///< elements that are left out, and where
};

/// `exists` says whether a file may be read. `file` is the URDF's absolute path. Errors: not
/// well-formed; a mesh of a package whose folder is unknown, or a scheme other than package://,
/// file:// and model://.
Result<UrdfText> prepare_urdf(const std::string& text, const std::filesystem::path& file,
                              const FileAccess& access,
                              const std::function<bool(const std::filesystem::path&)>& exists);

}  // namespace gloam
