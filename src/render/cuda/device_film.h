#pragma once
// The film of one picture on the card: the channels that the host asks for, and those that only
// kernels need.

#include "render/cuda/device_memory.h"
#include "render/cuda/kernels.h"
#include "render/film/film.h"

namespace gloam::cuda {

/// Channels that kernels need whether or not the host asks for them.
struct FilmNeeds {
  bool light = false, places = false, details = false, clear = false;
};

class DeviceFilmStore {
 public:
  /// Space for the channels that are not empty in `film`, and for those that are needed. No world's
  /// film refers to it any more.
  DeviceFilm place(const Film& film, const FilmNeeds& needs);
  /// Queues copies of the channels that `film` holds to pinned memory.
  void begin_download(const DeviceFilm& device, Film* film, Stream stream);
  /// After the stream has come so far: fills `film`, and returns the number of rays.
  uint64_t end_download(Film* film);

 private:
  DeviceBuffer device_;
  PinnedBuffer host_;
};

}  // namespace gloam::cuda
