// Open Image Denoise. On the CPU it reads and writes the film's own planes. A card has memory of
// its own: planes are copied there and the picture comes back.

#include <fmt/format.h>

#include <map>
#include <optional>
#include <string>

#include "base/check.h"
#include "base/parallel.h"
#include "render/film/border.h"
#include "render/film/denoise.h"
#include "render/film/oidn_api.h"

namespace gloam {
namespace {

/// Device on which the library computes.
struct Device {
  oidn::Device handle = nullptr;
  DenoiseDevice kind = DenoiseDevice::kCpu;
};

/// One plane of pixels in the card's memory.
class CardPlane {
 public:
  CardPlane(const oidn::Api& api, const Device& device, size_t bytes)
      : api_(api), bytes_(bytes), buffer_(api.new_buffer(device.handle, bytes)) {}
  ~CardPlane() { api_.release_buffer(buffer_); }
  CardPlane(const CardPlane&) = delete;
  CardPlane& operator=(const CardPlane&) = delete;

  size_t bytes() const { return bytes_; }
  oidn::Buffer buffer() const { return buffer_; }
  void write(const void* from) { api_.write_buffer(buffer_, 0, bytes_, from); }
  void read(void* to) const { api_.read_buffer(buffer_, 0, bytes_, to); }

 private:
  oidn::Api api_;
  size_t bytes_;
  oidn::Buffer buffer_;
};

/// One filter of the library. On the CPU planes stay the caller's until run() has returned.
class Filter {
 public:
  Filter(const oidn::Api& api, const Device& device, DenoiseQuality quality)
      : api_(api), device_(device), filter_(api.new_filter(device.handle, "RT")) {
    api_.set_int(filter_, "quality", oidn::kQuality[static_cast<int>(quality)]);
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
      api_.set_image(filter_, name, pixels, oidn::kFormatFloat3, width, height, 0, 0, 0);
      return;
    }
    std::unique_ptr<CardPlane>& plane = planes_[name];
    const size_t bytes = film.pixel_count() * sizeof(Vec3f);
    if (plane == nullptr || plane->bytes() != bytes)
      plane = std::make_unique<CardPlane>(api_, device_, bytes);
    api_.set_buffer_image(filter_, name, plane->buffer(), oidn::kFormatFloat3, width, height, 0, 0,
                          0);
  }

  oidn::Api api_;
  Device device_;
  oidn::Filter filter_;
  std::map<std::string, std::unique_ptr<CardPlane>> planes_;  // by the image's name; card only
};

class OidnDenoiser : public Denoiser {
 public:
  OidnDenoiser(const oidn::Api& api, const Device& device, DenoiseQuality quality)
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
    add_border(film, color_, oidn::kBorder, &wide_);
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
    if (api_.get_device_error(device_.handle, &message) != oidn::kErrorNone)
      return Error{ErrorKind::kIo, fmt::format("Open Image Denoise failed: {}", message)};
    remove_border(filtered_, film, oidn::kBorder, out);
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

  oidn::Api api_;
  Device device_;
  std::function<bool()> may_continue_;
  std::optional<Filter> color_filter_, albedo_filter_, normal_filter_;
  std::vector<Vec3f> color_, light_, filtered_;
  Film wide_;  // with its border
};

Result<Device> make_device(const oidn::Api& api, DenoiseDevice kind) {
  const bool on_card = kind == DenoiseDevice::kCuda;
  const oidn::Device device = api.new_device(on_card ? oidn::kDeviceCuda : oidn::kDeviceCpu);
  if (device != nullptr && !on_card) {
    api.set_device_int(device, "numThreads", thread_count());
    api.set_device_bool(device, "setAffinity", false);  // threads are shared
  }
  GLOAM_TRY(const oidn::Device committed, oidn::commit(api, device, on_card ? "GPU" : "machine"));
  return Device{committed, kind};
}

}  // namespace

Result<std::unique_ptr<Denoiser>> make_oidn_denoiser(const DenoiseOptions& options) {
  GLOAM_TRY(const oidn::Api api, oidn::load_api());
  GLOAM_TRY(const Device device, make_device(api, options.device));
  return std::unique_ptr<Denoiser>(new OidnDenoiser(api, device, options.quality));
}

}  // namespace gloam
