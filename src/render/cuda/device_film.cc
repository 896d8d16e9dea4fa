#include "render/cuda/device_film.h"

#include <cstring>

#include "base/parallel.h"
#include "render/kernel/camera/channels.h"

namespace gloam::cuda {
namespace {

/// Calls visit(channel of the film, pointer in DeviceFilm, whether kernels need it) for each.
template <class Film_, class DeviceFilm_, class Visit>
void each_channel(Film_& film, DeviceFilm_& device, const FilmNeeds& needs, const Visit& visit) {
  visit(film.radiance, device.radiance, needs.light);
  visit(film.variance, device.squares, false);
  visit(film.albedo, device.albedo, needs.light);
  visit(film.normal, device.normal, needs.light);
  visit_places([&](auto& plane, auto& at) { visit(plane, at, needs.places); }, film, device);
  visit_details([&](auto& plane, auto& at) { visit(plane, at, needs.details); }, film, device);
}

template <class T>
size_t bytes_of(const std::vector<T>& channel) {
  return channel.size() * sizeof(T);
}

/// Where a channel lies in the copy, behind the number of rays.
size_t next(size_t at, size_t bytes) { return (at + bytes + 255) / 256 * 256; }
constexpr size_t kFirst = 256;

}  // namespace

DeviceFilm DeviceFilmStore::place(const Film& film, const FilmNeeds& needs) {
  DeviceFilm out;
  const auto each = [&](DeviceLayout* layout) {
    layout->put(&out.rays, 1);
    if (needs.clear) layout->put(&out.clear, film.pixel_count());
    each_channel(film, out, needs, [&](const auto& channel, auto& at, bool needed) {
      if (!channel.empty() || needed) layout->put(&at, film.pixel_count());
    });
  };
  DeviceLayout measured;
  each(&measured);
  DeviceLayout layout(device_.reserve(measured.bytes()));
  each(&layout);
  return out;
}

void DeviceFilmStore::begin_download(const DeviceFilm& device, Film* film, Stream stream) {
  size_t bytes = next(kFirst, bytes_of(film->rgb));
  each_channel(*film, device, {},
               [&](const auto& channel, auto, bool) { bytes = next(bytes, bytes_of(channel)); });
  char* host = host_.reserve(bytes);
  const auto copy = [&](size_t at, const void* from, size_t count) {
    if (count == 0) return;
    check(cudaMemcpyAsync(host + at, from, count, cudaMemcpyDeviceToHost, stream),
          "cannot copy the image from the GPU");
  };
  copy(0, device.rays, sizeof *device.rays);
  size_t at = kFirst;
  const auto add = [&](const auto& channel, const auto* from) {
    copy(at, from, bytes_of(channel));
    at = next(at, bytes_of(channel));
  };
  add(film->rgb, device.rgb);
  each_channel(*film, device, {},
               [&](const auto& channel, const auto* from, bool) { add(channel, from); });
}

uint64_t DeviceFilmStore::end_download(Film* film) {
  const char* host = host_.reserve(0);
  size_t at = kFirst;
  const auto take = [&](auto& channel) {
    const auto size = static_cast<int64_t>(bytes_of(channel));
    char* const to = reinterpret_cast<char*>(channel.data());
    parallel_for_range("copy from the card", size, 1 << 20, [&](int64_t begin, int64_t end) {
      std::memcpy(to + begin, host + at + begin, static_cast<size_t>(end - begin));
    });
    at = next(at, bytes_of(channel));
  };
  take(film->rgb);
  DeviceFilm none;
  each_channel(*film, none, {}, [&](auto& channel, auto, bool) { take(channel); });
  unsigned long long rays = 0;
  std::memcpy(&rays, host, sizeof rays);
  return rays;
}

}  // namespace gloam::cuda
