#include "render/film/oidn_api.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "base/files.h"

namespace gloam::oidn {
namespace {
namespace fs = std::filesystem;

constexpr const char* kLibrary = "libOpenImageDenoise.so.2";

/// The library's functions, or false when one is missing.
bool load_functions(void* library, Api* api) {
  bool complete = true;
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    complete = complete && function != nullptr;
  };
  load(api->new_device, "oidnNewDevice");
  load(api->new_cuda_device, "oidnNewCUDADevice");
  load(api->set_device_int, "oidnSetDeviceInt");
  load(api->set_device_bool, "oidnSetDeviceBool");
  load(api->commit_device, "oidnCommitDevice");
  load(api->release_device, "oidnReleaseDevice");
  load(api->get_device_error, "oidnGetDeviceError");
  load(api->new_filter, "oidnNewFilter");
  load(api->set_image, "oidnSetSharedFilterImage");
  load(api->set_buffer_image, "oidnSetFilterImage");
  load(api->unset_image, "oidnUnsetFilterImage");
  load(api->new_buffer, "oidnNewBuffer");
  load(api->write_buffer, "oidnWriteBuffer");
  load(api->read_buffer, "oidnReadBuffer");
  load(api->release_buffer, "oidnReleaseBuffer");
  load(api->set_bool, "oidnSetFilterBool");
  load(api->set_int, "oidnSetFilterInt");
  load(api->commit_filter, "oidnCommitFilter");
  load(api->execute_filter, "oidnExecuteFilter");
  load(api->execute_filter_async, "oidnExecuteFilterAsync");
  load(api->set_monitor, "oidnSetFilterProgressMonitorFunction");
  load(api->release_filter, "oidnReleaseFilter");
  return complete;
}

std::vector<fs::path> candidates() {
  std::vector<fs::path> paths;
  if (const char* user = std::getenv("GLOAM_OIDN"); user != nullptr && *user != 0) {
    std::error_code code;
    paths.emplace_back(fs::is_directory(user, code) ? fs::path(user) / kLibrary : fs::path(user));
    return paths;  // the user's word is final
  }
  if (const Result<fs::path> home = gloam_home(); home.ok()) {
    paths.push_back(*home / ".venv" / "wheels" / "pyoidn" / "oidn" / "lib" / kLibrary);
    const fs::path prefix = home->parent_path().parent_path();  // of an installation
    paths.push_back(prefix / "lib" / "gloam" / "oidn" / "lib" / kLibrary);
  }
  paths.emplace_back(kLibrary);  // wherever the system looks
  return paths;
}

}  // namespace

Result<Api> load_api() {
  void* library = nullptr;
  std::string cause;
  for (const fs::path& path : candidates()) {
    // Never unloaded: its threads may outlive the last denoiser.
    library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (library != nullptr) break;
    cause = dlerror();
  }
  if (library == nullptr) {
    return Error{ErrorKind::kUnsupported,
                 fmt::format("Open Image Denoise is not installed: {}", cause),
                 {},
                 "run ./gloam setup, or set GLOAM_OIDN to its library"};
  }
  Api api;
  if (!load_functions(library, &api))
    return Error{ErrorKind::kUnsupported,
                 "the installed Open Image Denoise is older than version 2",
                 {},
                 "install version 2.3 or later"};
  return api;
}

Result<Device> commit(const Api& api, Device device, const char* where) {
  if (device != nullptr) api.commit_device(device);
  const char* message = "";
  if (api.get_device_error(device, &message) == kErrorNone && device != nullptr) return device;
  Error error{ErrorKind::kUnsupported,
              fmt::format("Open Image Denoise does not run on this {}: {}", where, message)};
  if (device != nullptr) api.release_device(device);
  return error;
}

}  // namespace gloam::oidn
