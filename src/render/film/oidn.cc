// Open Image Denoise through its C API, declared here from its public documentation
// (https://www.openimagedenoise.org/documentation.html, version 2): no headers are needed to build.
// On the CPU it reads and writes the film's own planes. A card has memory of its own: planes are
// copied there and the picture comes back.

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/check.h"
#include "base/files.h"
#include "base/parallel.h"
#include "render/film/border.h"
#include "render/film/denoise.h"

namespace gloam {
namespace {
namespace fs = std::filesystem;

constexpr const char* kLibrary = "libOpenImageDenoise.so.2";
constexpr int kDeviceCpu = 1, kDeviceCuda = 3, kFormatFloat3 = 3, kErrorNone = 0;
constexpr int kQuality[] = {4, 5, 6};  // fast, balanced, high

using OidnDevice = void*;
using OidnFilter = void*;
using OidnBuffer = void*;

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
  void (*set_buffer_image)(OidnFilter, const char* name, OidnBuffer, int format, size_t width,
                           size_t height, size_t offset, size_t pixel_stride,
                           size_t row_stride) = nullptr;
  void (*unset_image)(OidnFilter, const char* name) = nullptr;
  OidnBuffer (*new_buffer)(OidnDevice, size_t bytes) = nullptr;
  void (*write_buffer)(OidnBuffer, size_t offset, size_t bytes, const void* from) = nullptr;
  void (*read_buffer)(OidnBuffer, size_t offset, size_t bytes, void* to) = nullptr;
  void (*release_buffer)(OidnBuffer) = nullptr;
  void (*set_bool)(OidnFilter, const char* name, bool value) = nullptr;
  void (*set_int)(OidnFilter, const char* name, int value) = nullptr;
  void (*commit_filter)(OidnFilter) = nullptr;
  void (*execute_filter)(OidnFilter) = nullptr;
  void (*set_monitor)(OidnFilter, bool (*progress)(void* user, double done), void* user) = nullptr;
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

/// Device on which the library computes.
struct Device {
  OidnDevice handle = nullptr;
  DenoiseDevice kind = DenoiseDevice::kCpu;
};

/// One plane of pixels in the card's memory.
class CardPlane {
 public:
  CardPlane(const OidnApi& api, const Device& device, size_t bytes)
      : api_(api), bytes_(bytes), buffer_(api.new_buffer(device.handle, bytes)) {}
  ~CardPlane() { api_.release_buffer(buffer_); }
  CardPlane(const CardPlane&) = delete;
  CardPlane& operator=(const CardPlane&) = delete;

  size_t bytes() const { return bytes_; }
  OidnBuffer buffer() const { return buffer_; }
  void write(const void* from) { api_.write_buffer(buffer_, 0, bytes_, from); }
  void read(void* to) const { api_.read_buffer(buffer_, 0, bytes_, to); }

 private:
  OidnApi api_;
  size_t bytes_;
  OidnBuffer buffer_;
};

/// One filter of the library. On the CPU planes stay the caller's until run() has returned.
class Filter {
 public:
  Filter(const OidnApi& api, const Device& device, DenoiseQuality quality)
      : api_(api), device_(device), filter_(api.new_filter(device.handle, "RT")) {
    api_.set_int(filter_, "quality", kQuality[static_cast<int>(quality)]);
  }
  ~Filter() {
    api_.release_filter(filter_);  // before the planes that it refers to
    planes_.clear();
  }
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;

  void set(const char* name, bool value) { api_.set_bool(filter_, name, value); }
  /// `may_continue` outlives the runs.
  void watch(std::function<bool()>* may_continue) {
    api_.set_monitor(
        filter_, [](void* user, double) { return (*static_cast<std::function<bool()>*>(user))(); },
        may_continue);
  }
  /// A plane that does not have the film's size is left out.
  void set_input(const char* name, const std::vector<Vec3f>& plane, const Film& film) {
    if (plane.size() != film.pixel_count()) {
      api_.unset_image(filter_, name);
      return;
    }
    bind(name, const_cast<Vec3f*>(plane.data()), film);
    if (device_.kind == DenoiseDevice::kCuda) planes_.at(name)->write(plane.data());
  }
  /// Filters the inputs into `out`, which has the film's size.
  void run(const Film& film, std::vector<Vec3f>* out) {
    bind("output", out->data(), film);
    api_.commit_filter(filter_);
    api_.execute_filter(filter_);
    if (device_.kind == DenoiseDevice::kCuda) planes_.at("output")->read(out->data());
  }

 private:
  void bind(const char* name, Vec3f* pixels, const Film& film) {
    const auto width = static_cast<size_t>(film.width), height = static_cast<size_t>(film.height);
    if (device_.kind == DenoiseDevice::kCpu) {
      api_.set_image(filter_, name, pixels, kFormatFloat3, width, height, 0, 0, 0);
      return;
    }
    std::unique_ptr<CardPlane>& plane = planes_[name];
    const size_t bytes = film.pixel_count() * sizeof(Vec3f);
    if (plane == nullptr || plane->bytes() != bytes)
      plane = std::make_unique<CardPlane>(api_, device_, bytes);
    api_.set_buffer_image(filter_, name, plane->buffer(), kFormatFloat3, width, height, 0, 0, 0);
  }

  OidnApi api_;
  Device device_;
  OidnFilter filter_;
  std::map<std::string, std::unique_ptr<CardPlane>> planes_;  // by the image's name; card only
};

class OidnDenoiser : public Denoiser {
 public:
  OidnDenoiser(const OidnApi& api, const Device& device, DenoiseQuality quality)
      : api_(api), device_(device), color_filter_(std::in_place, api, device, quality) {
    color_filter_->set("hdr", true);
    if (quality != DenoiseQuality::kHigh) return;
    albedo_filter_.emplace(api, device, quality);
    normal_filter_.emplace(api, device, quality);
  }
  ~OidnDenoiser() override {
    color_filter_.reset();  // filters before their device
    albedo_filter_.reset();
    normal_filter_.reset();
    api_.release_device(device_.handle);
  }
  OidnDenoiser(const OidnDenoiser&) = delete;
  OidnDenoiser& operator=(const OidnDenoiser&) = delete;

  Status denoise(const Film& film, std::vector<Vec3f>* out) override {
    remove_fireflies(film, &color_, &light_);
    add_border(film, color_, kBorder, &wide_);
    const bool clean = albedo_filter_ && normal_filter_ && has_normal(wide_);
    if (clean) {
      clean_up("albedo", wide_, &*albedo_filter_, &wide_.albedo);
      clean_up("normal", wide_, &*normal_filter_, &wide_.normal);
    }
    const std::vector<Vec3f> none;
    GLOAM_CHECK(color_filter_.has_value(), "the denoiser was created without its filter");
    Filter& filter = *color_filter_;
    filter.set("cleanAux", clean);
    filter.set_input("color", wide_.radiance, wide_);
    filter.set_input("albedo", wide_.albedo, wide_);
    filter.set_input("normal", has_normal(wide_) ? wide_.normal : none, wide_);
    filtered_.resize(wide_.pixel_count());
    filter.run(wide_, &filtered_);
    const char* message = nullptr;
    if (api_.get_device_error(device_.handle, &message) != kErrorNone)
      return Error{ErrorKind::kIo, fmt::format("Open Image Denoise failed: {}", message)};
    remove_border(filtered_, film, kBorder, out);
    restore_light(light_, film.width, film.height, out);
    return {};
  }

  void set_may_continue(std::function<bool()> may_continue) override {
    may_continue_ = std::move(may_continue);
    for (auto* filter : {&color_filter_, &albedo_filter_, &normal_filter_})
      if (*filter) (*filter)->watch(&may_continue_);
  }

  const char* name() const override {
    return device_.kind == DenoiseDevice::kCuda ? "Open Image Denoise on the GPU"
                                                : "Open Image Denoise";
  }

 private:
  /// Width beyond which the network's padding no longer shows. Roughness of a noisy wall's
  /// outermost row over that of the eighth: 5.4 without, 1.5 with 4 pixels, 1.3 with 8 and with 16.
  static constexpr int kBorder = 8;

  /// The library takes normals only together with albedo.
  static bool has_normal(const Film& film) {
    return film.albedo.size() == film.pixel_count() && film.normal.size() == film.pixel_count();
  }
  void clean_up(const char* name, const Film& film, Filter* filter, std::vector<Vec3f>* plane) {
    filtered_.resize(plane->size());
    filter->set_input(name, *plane, film);
    filter->run(film, &filtered_);
    std::swap(filtered_, *plane);
  }

  OidnApi api_;
  Device device_;
  std::function<bool()> may_continue_;
  std::optional<Filter> color_filter_, albedo_filter_, normal_filter_;
  std::vector<Vec3f> color_, light_, filtered_;
  Film wide_;  // with its border
};

Result<Device> make_device(const OidnApi& api, DenoiseDevice kind) {
  const Device device{api.new_device(kind == DenoiseDevice::kCuda ? kDeviceCuda : kDeviceCpu),
                      kind};
  if (device.handle != nullptr) {
    if (kind == DenoiseDevice::kCpu) {
      api.set_device_int(device.handle, "numThreads", thread_count());
      api.set_device_bool(device.handle, "setAffinity", false);  // threads are shared
    }
    api.commit_device(device.handle);
  }
  const char* message = "";
  if (api.get_device_error(device.handle, &message) == kErrorNone && device.handle != nullptr)
    return device;
  Error error{ErrorKind::kUnsupported,
              fmt::format("Open Image Denoise does not run on this {}: {}",
                          kind == DenoiseDevice::kCuda ? "GPU" : "machine", message)};
  if (device.handle != nullptr) api.release_device(device.handle);
  return error;
}

}  // namespace

Result<std::unique_ptr<Denoiser>> make_oidn_denoiser(const DenoiseOptions& options) {
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
                 "the installed Open Image Denoise is older than version 2",
                 {},
                 "install version 2.3 or later"};
  GLOAM_TRY(const Device device, make_device(api, options.device));
  return std::unique_ptr<Denoiser>(new OidnDenoiser(api, device, options.quality));
}

}  // namespace gloam
