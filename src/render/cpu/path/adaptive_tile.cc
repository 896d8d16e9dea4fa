#include "render/cpu/path/adaptive_tile.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace gloam {

namespace {

/// Rounds double: the number of samples that is nearest to the one wanted, by its ratio.
constexpr double kRounding = 1.41421356;

class AdaptiveTile {
 public:
  AdaptiveTile(const Job& job, int x0, int y0)
      : job_(job), x0_(x0), y0_(y0), most_(job.settings.spp / 2) {}

  /// See look_adaptive.
  double look(RenderStats* stats) {
    Tile tile(job_, x0_, y0_);
    sample(&tile, 0, kPilotSeed, 0, kPilotSamples);
    stats->rays += tile.rays();
    stats->paths += static_cast<uint64_t>(tile.count()) * kPilotSamples;
    for (int i = 0; i < tile.count(); ++i) ++blocks_[block_of(tile.index(i))].pixels;
    add_squares(tile, 0);
    double squares = 0;
    for (const Block& block : blocks_) squares += block.squares[0];
    return std::sqrt(kPilotSamples * squares / tile.count());
  }

  void render(const AdaptivePlan& plan, RenderStats* stats) {
    const Tile all(job_, x0_, y0_);
    Film& film = *job_.film;
    for (int i = 0; i < all.count(); ++i) {
      Block& block = blocks_[block_of(all.index(i))];
      block.open = true;
      ++block.pixels;
      const size_t pixel = all.pixel_of(i);
      film.radiance[pixel] = film.albedo[pixel] = film.normal[pixel] = {};
      if (job_.settings.variance) film.variance[pixel] = {};
      film.sample_count[pixel] = 0;
    }
    int sampled = 0;
    while (std::any_of(blocks_, std::end(blocks_), [](const Block& b) { return b.open; })) {
      const int next = sampled == 0 ? std::min(plan.least, most_) : std::min(2 * sampled, most_);
      Tile tile(job_, x0_, y0_, [this](int index) { return blocks_[block_of(index)].open; });
      for (int half = 0; half < 2; ++half) {
        sample(&tile, half, half == 0 ? 0 : kSecondHalfSeed, sampled, next);
      }
      stats->rays += tile.rays();
      stats->paths +=
          2 * static_cast<uint64_t>(tile.count()) * static_cast<uint64_t>(next - sampled);
      sampled = next;
      decide(tile, plan, sampled, stats);
    }
  }

 private:
  static constexpr int kBatches = 4;
  static constexpr int kPilotSamples = 8;
  // Seeds that scramble the sampler, each in its own way; arbitrary.
  static constexpr uint64_t kSecondHalfSeed = 0xD1B54A32D192ED03u, kPilotSeed = 0x8CB92BA72F3D8DD7u;
  static constexpr int kSide = 8;  // of a block [px]
  static constexpr int kAcross = kTile / kSide;
  static_assert(kTile % kSide == 0 && kLeastAdaptiveSpp >= 2 * kBatches);

  static float mean_of_channels(Vec3f c) { return (c.x + c.y + c.z) / 3; }

  struct Batch {
    Vec3f mean;
    int count = 0;
    void add(const Batch& b) {
      count += b.count;
      mean += (b.mean - mean) * (static_cast<float>(b.count) / static_cast<float>(count));
    }
  };
  struct Half {
    Batch batches[kBatches];
    Batch all() const {
      Batch sum;
      for (const Batch& b : batches) sum.add(b);
      return sum;
    }
    /// Mean of all channels, without the brightest and the darkest batch: one bright path among few
    /// samples raises the variance and must not raise the value that this is compared with.
    float value() const {
      float least = INFINITY, most = 0, sum = 0;
      for (const Batch& b : batches) {
        const float x = mean_of_channels(b.mean);
        least = min(least, x);
        most = max(most, x);
        sum += x;
      }
      return (sum - least - most) / (kBatches - 2);
    }
    /// Variance of the mean, per channel.
    Vec3f variance(const Batch& all) const {
      Vec3f squares;
      for (const Batch& b : batches) {
        const Vec3f d = b.mean - all.mean;
        squares += d * d * static_cast<float>(b.count);
      }
      return squares / (static_cast<float>(all.count) * (kBatches - 1));
    }
  };
  struct Block {
    bool open = false;  ///< is sampled
    int pixels = 0;
    int counted[2] = {0, 0};     ///< samples of a half's mean; 0 = not decided
    double squares[2] = {0, 0};  ///< sum of the squares of the errors of a half's means
    float value = 0;             ///< mean over the pixels
  };

  /// Squares of the errors of a half's means, per block.
  void add_squares(const Tile& tile, int half) {
    for (Block& block : blocks_) block.squares[half] = block.value = 0;
    for (int i = 0; i < tile.count(); ++i) {
      Block& block = blocks_[block_of(tile.index(i))];
      block.value += halves_[half][tile.index(i)].value() / static_cast<float>(block.pixels);
    }
    for (int i = 0; i < tile.count(); ++i) {
      const Half& samples = halves_[half][tile.index(i)];
      Block& block = blocks_[block_of(tile.index(i))];
      const double value = max((samples.value() + block.value) / 2, job_.settings.error_floor);
      const float variance = mean_of_channels(samples.variance(samples.all()));
      block.squares[half] += value > 0 ? double{variance} / (value * value) : 0;
    }
  }
  static int block_of(int index) {
    int x, y;
    tile_pixel(index, &x, &y);
    return y / kSide * kAcross + x / kSide;
  }

  /// The samples [sampled, next) of one half. In the first round they make four batches; later
  /// those before make two and these the others.
  void sample(Tile* tile, int half, uint64_t other, int sampled, int next) {
    const int parts = sampled == 0 ? kBatches : kBatches / 2;
    for (int i = 0; sampled > 0 && i < tile->count(); ++i) {
      Batch* b = halves_[half][tile->index(i)].batches;
      for (int k = 0; k < kBatches / 2; ++k) {
        const Batch later = b[2 * k + 1];
        b[k] = b[2 * k];
        b[k].add(later);
      }
    }
    Film& film = *job_.film;
    for (int part = 0; part < parts; ++part) {
      const int begin = sampled + (next - sampled) * part / parts;
      const int end = sampled + (next - sampled) * (part + 1) / parts;
      tile->render_path({job_.settings.seed ^ other, begin, end - begin});
      for (int i = 0; i < tile->count(); ++i) {
        PixelMean& mean = tile->mean(i);
        halves_[half][tile->index(i)].batches[kBatches - parts + part] = {mean.radiance,
                                                                          mean.count};
        const size_t pixel = tile->pixel_of(i);
        film.albedo[pixel] += mean.albedo * static_cast<float>(mean.count);
        film.normal[pixel] += mean.normal * static_cast<float>(mean.count);
        mean = {};
      }
    }
  }

  void decide(const Tile& tile, const AdaptivePlan& plan, int sampled, RenderStats* stats) {
    for (int half = 0; half < 2; ++half) add_squares(tile, half);
    bool fixed[2][kAcross * kAcross] = {};
    for (int b = 0; b < kAcross * kAcross; ++b) {
      Block& block = blocks_[b];
      if (!block.open) continue;
      bool reached = true;
      for (int half = 0; half < 2; ++half) {
        const bool enough = wanted(plan, block, 1 - half, sampled) <= kRounding * 2 * sampled;
        reached = reached && (enough || block.counted[half] > 0);
        fixed[half][b] = block.counted[half] == 0 && (enough || sampled == most_);
        if (fixed[half][b]) block.counted[half] = sampled;
      }
      if (!reached && sampled == most_) stats->unreached += static_cast<uint64_t>(block.pixels);
      block.open = block.counted[0] == 0 || block.counted[1] == 0;
    }
    for (int i = 0; i < tile.count(); ++i) {
      const int b = block_of(tile.index(i));
      for (int half = 0; half < 2; ++half) {
        if (fixed[half][b]) count(halves_[half][tile.index(i)], tile.pixel_of(i));
      }
      if (!blocks_[b].open) finish_guides(tile.pixel_of(i), 2 * sampled);
    }
  }

  /// Samples of a pixel of the block, as the half shows that has `sampled` of them.
  static double wanted(const AdaptivePlan& plan, const Block& block, int half, int sampled) {
    return plan.per_deviation * std::sqrt(sampled * block.squares[half] / block.pixels);
  }

  /// The mean of a half becomes part of the picture.
  void count(const Half& half, size_t pixel) {
    Film& film = *job_.film;
    const Batch all = half.all();
    film.radiance[pixel] += all.mean * 0.5f;
    if (job_.settings.variance) film.variance[pixel] += half.variance(all) * 0.25f;
    film.sample_count[pixel] += static_cast<uint32_t>(all.count);
  }
  /// Guides are the means of all that was sampled.
  void finish_guides(size_t pixel, int sampled) {
    job_.film->albedo[pixel] *= 1.0f / static_cast<float>(sampled);
    job_.film->normal[pixel] *= 1.0f / static_cast<float>(sampled);
  }

  const Job& job_;
  const int x0_, y0_, most_;
  Block blocks_[kAcross * kAcross];
  Half halves_[2][kTile * kTile];
};

}  // namespace

double look_adaptive(const Job& job, int x0, int y0, RenderStats* stats) {
  return std::make_unique<AdaptiveTile>(job, x0, y0)->look(stats);
}

AdaptivePlan plan_adaptive(const RenderSettings& settings, const std::vector<double>& deviations,
                           const std::vector<int>& pixels) {
  double sum = 0, squares = 0, count = 0;
  for (size_t i = 0; i < deviations.size(); ++i) {
    sum += deviations[i] * pixels[i];
    squares += deviations[i] * deviations[i] * pixels[i];
    count += pixels[i];
  }
  AdaptivePlan plan;
  const double target = double{settings.error} * settings.error;
  plan.per_deviation = sum / count / target;
  plan.least = kLeastAdaptiveSpp / 2;
  constexpr double kLeastShare = 0.5;
  while (4 * plan.least <= settings.spp &&
         kRounding * 2 * plan.least < kLeastShare * squares / count / target) {
    plan.least *= 2;
  }
  return plan;
}

void render_adaptive(const Job& job, int x0, int y0, const AdaptivePlan& plan, RenderStats* stats) {
  std::make_unique<AdaptiveTile>(job, x0, y0)->render(plan, stats);
}

}  // namespace gloam
