// Open Image Denoise through its C API, declared here from its public documentation
// (https://www.openimagedenoise.org/documentation.html, version 2): no headers are needed to build.

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "base/check.h"
#include "base/files.h"
#include "base/parallel.h"
#include "render/film/denoise.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr const char* kLibrary = "libOpenImageDenoise.so.2";
constexpr int kDeviceCpu = 1, kFormatFloat3 = 3, kErrorNone = 0;
constexpr int kQuality[] = {4, 5, 6};  // fast, balanced, high

using OidnDevice = void*;
using OidnFilter = void*;

struct OidnApi {
  OidnDevice (*new_device)(int type) = nullptr;
  void (*set_device_int)(OidnDevice, const char* name, int value) = nullptr;
  void (*set_device_bool)(OidnDevice, const char* name, bool value) = nullptr;
  void (*commit_device)(OidnDevice) = nullptr;
  void (*release_device)(OidnDevice) = nullptr;
  int (*get_device_error)(OidnDevice, const char** message) = nullptr;
  OidnFilter (*new_filter)(OidnDevice, const char* type) = nullptr;
  void (*set_image)(OidnFilter, const char* name, void* data, int format, size_t width,
                    size_t height, size_t offset, size_t pixel_stride, size_t row_stride) = nullptr;
  void (*unset_image)(OidnFilter, const char* name) = nullptr;
  void (*set_bool)(OidnFilter, const char* name, bool value) = nullptr;
  void (*set_int)(OidnFilter, const char* name, int value) = nullptr;
  void (*commit_filter)(OidnFilter) = nullptr;
  void (*execute_filter)(OidnFilter) = nullptr;
  void (*release_filter)(OidnFilter) = nullptr;
};

/// The library's functions, or false when one is missing.
bool load_functions(void* library, OidnApi* api) {
  bool complete = true;
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(library, name));
    complete = complete && function != nullptr;
  };
  load(api->new_device, "oidnNewDevice");
  load(api->set_device_int, "oidnSetDeviceInt");
  load(api->set_device_bool, "oidnSetDeviceBool");
  load(api->commit_device, "oidnCommitDevice");
  load(api->release_device, "oidnReleaseDevice");
  load(api->get_device_error, "oidnGetDeviceError");
  load(api->new_filter, "oidnNewFilter");
  load(api->set_image, "oidnSetSharedFilterImage");
  load(api->unset_image, "oidnUnsetFilterImage");
  load(api->set_bool, "oidnSetFilterBool");
  load(api->set_int, "oidnSetFilterInt");
  load(api->commit_filter, "oidnCommitFilter");
  load(api->execute_filter, "oidnExecuteFilter");
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
  if (const Result<fs::path> home = gloam_home(); home.ok())
    paths.push_back(home.value() / ".venv" / "wheels" / "pyoidn" / "oidn" / "lib" / kLibrary);
  paths.emplace_back(kLibrary);  // wherever the system looks
  return paths;
}

class OidnDenoiser : public Denoiser {
 public:
  OidnDenoiser(const OidnApi& api, OidnDevice device, DenoiseQuality quality)
      : api_(api), device_(device), filter_(api.new_filter(device, "RT")) {
    api_.set_bool(filter_, "hdr", true);
    api_.set_int(filter_, "quality", kQuality[static_cast<int>(quality)]);
  }
  ~OidnDenoiser() override {
    api_.release_filter(filter_);
    api_.release_device(device_);
  }
  OidnDenoiser(const OidnDenoiser&) = delete;
  OidnDenoiser& operator=(const OidnDenoiser&) = delete;

  Status denoise(const Film& film, std::vector<Vec3f>* out) override {
    remove_fireflies(film, &color_);
    out->resize(film.pixel_count());
    const auto set = [&](const char* name, const std::vector<Vec3f>& plane) {
      if (plane.size() != film.pixel_count()) {
        api_.unset_image(filter_, name);
        return;
      }
      api_.set_image(filter_, name, const_cast<Vec3f*>(plane.data()), kFormatFloat3,
                     static_cast<size_t>(film.width), static_cast<size_t>(film.height), 0, 0, 0);
    };
    set("color", color_);
    set("albedo", film.albedo);
    // The library takes normals only together with albedo.
    set("normal", film.albedo.empty() ? film.albedo : film.normal);
    set("output", *out);
    api_.commit_filter(filter_);
    api_.execute_filter(filter_);
    const char* message = nullptr;
    if (api_.get_device_error(device_, &message) != kErrorNone)
      return Error{ErrorKind::kIo, fmt::format("Open Image Denoise failed: {}", message)};
    return {};
  }

  const char* name() const override { return "Open Image Denoise"; }

 private:
  OidnApi api_;
  OidnDevice device_;
  OidnFilter filter_;
  std::vector<Vec3f> color_;
};

}  // namespace

Result<std::unique_ptr<Denoiser>> make_oidn_denoiser(DenoiseQuality quality) {
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
  OidnApi api;
  if (!load_functions(library, &api))
    return Error{ErrorKind::kUnsupported,
                 "this Open Image Denoise is older than version 2",
                 {},
                 "install version 2.3 or later"};
  OidnDevice device = api.new_device(kDeviceCpu);
  if (device != nullptr) {
    api.set_device_int(device, "numThreads", thread_count());
    api.set_device_bool(device, "setAffinity", false);  // its threads are shared with everyone
    api.commit_device(device);
  }
  const char* message = "";
  if (api.get_device_error(device, &message) != kErrorNone || device == nullptr) {
    Error error{ErrorKind::kUnsupported,
                fmt::format("Open Image Denoise does not run on this machine: {}", message)};
    if (device != nullptr) api.release_device(device);
    return error;
  }
  return std::unique_ptr<Denoiser>(new OidnDenoiser(api, device, quality));
}

}  // namespace gloam
