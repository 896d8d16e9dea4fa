// Any name that a model may give a file: what is allowed lies inside the model's root.

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "scene/files/model_path.h"

namespace fs = std::filesystem;

namespace {

// /tmp/…/a/b/c/d/e/f holds the model; links point out, in and in a circle.
fs::path make_tree() {
  const fs::path top =
      fs::temp_directory_path() / ("gloam_path_fuzz_" + std::to_string(::getpid()));
  const fs::path folder = top / "a/b/c/d/e/f";
  fs::create_directories(folder / "meshes");
  std::ofstream(folder / "model.xml") << "<mujoco/>";
  std::error_code code;
  fs::create_symlink("/etc", folder / "out", code);
  fs::create_symlink("meshes", folder / "in", code);
  fs::create_symlink("loop", folder / "loop", code);
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fs::path folder = make_tree();
  const std::string name(reinterpret_cast<const char*>(data), size);
  if (!gloam::why_not_a_path(name).empty()) return 0;
  for (const bool strict : {false, true}) {
    gloam::FileAccess access;
    access.strict = strict;
    const auto root = gloam::find_model_root(folder / "model.xml", access);
    if (!root.ok()) std::abort();
    const fs::path path = gloam::absolute_path(name, folder);
    if (!gloam::why_not_readable(path, {*root}).empty()) continue;
    // Four levels above the model at most; the independent check is the operating system's.
    const fs::path limit =
        strict ? folder : folder.parent_path().parent_path().parent_path().parent_path();
    std::error_code code;
    const fs::path real = fs::weakly_canonical(path, code);
    const std::string inside = fs::canonical(limit).string() + "/";
    if (code || real.string().rfind(inside, 0) != 0) std::abort();
  }
  (void)gloam::find_package(name, folder / "model.xml", {});
  return 0;
}
