#include "scene/files/mujoco_plugins.h"

#include <dlfcn.h>
#include <mujoco/mujoco.h>

#include <filesystem>
#include <mutex>

#include "scene/files/mujoco_guard.h"

namespace gloam {

void load_mujoco_plugins() {
  static std::once_flag once;
  std::call_once(once, [] {
    install_mujoco_handler();
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(&mj_step), &info) == 0 || info.dli_fname == nullptr) return;
    std::error_code code;
    const std::filesystem::path folder =
        std::filesystem::canonical(info.dli_fname, code).parent_path() / "plugin";
    if (!std::filesystem::is_directory(folder, code)) return;
    const std::string name = folder.string();
    const MujocoWarningCapture capture;  // a library that does not load is MuJoCo's to skip
    try_mujoco([&] { mj_loadAllPluginLibraries(name.c_str(), nullptr); });
  });
}

}  // namespace gloam
