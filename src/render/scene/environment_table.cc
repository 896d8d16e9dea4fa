#include "render/scene/environment_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/parallel.h"
#include "geometry/image/image_file.h"

namespace gloam {
namespace {

/// Below this many rows the sine of the polar angle is too coarse for the density: rows are added.
constexpr int kLeastRows = 33;
/// Least chance of a step with any light, as a fraction of its running sum: four units in the last
/// place of a float near one, so that rounding leaves none empty.
constexpr double kLeastShare = 0x1p-22;

Error map_error(const std::string& name, std::string message, std::string hint = {}) {
  return {ErrorKind::kInput, std::move(message), {name, 0, 0}, std::move(hint)};
}

Status check_texels(int width, int height, std::span<const Vec3f> texels, const std::string& name) {
  if (width < 1 || height < 1) {
    return map_error(name,
                     fmt::format("an environment map cannot have {} x {} texels", width, height));
  }
  if (static_cast<uint64_t>(width) * static_cast<uint64_t>(height) > kMaxImagePixels) {
    return map_error(
        name,
        fmt::format("an environment map of {} x {} texels is too large; the limit is {} texels",
                    width, height, kMaxImagePixels));
  }
  if (texels.size() != static_cast<size_t>(width) * static_cast<size_t>(height)) {
    return map_error(name, fmt::format("{} texels for an environment map of {} x {}", texels.size(),
                                       width, height));
  }
  for (size_t i = 0; i < texels.size(); ++i) {
    const Vec3f t = texels[i];
    // 1e30 leaves room for sums over the sphere.
    if (t.x >= 0 && t.y >= 0 && t.z >= 0 && max_component(t) <= 1e30f) continue;
    return map_error(
        name,
        fmt::format("texel in column {}, row {} of the environment map is ({}, {}, {})",
                    i % static_cast<size_t>(width), i / static_cast<size_t>(width), t.x, t.y, t.z),
        "radiance must be finite and not negative; clamp the map in the program that created it");
  }
  return {};
}

/// Rows k-fold, k odd: the old rows stay rows, and between them the look-up is linear as before.
std::vector<Vec3f> add_rows(int width, int height, std::span<const Vec3f> texels, int k) {
  std::vector<Vec3f> out(texels.size() * static_cast<size_t>(k));
  for (int row = 0; row < height * k; ++row) {
    const float y = (static_cast<float>(row) + 0.5f) / static_cast<float>(height * k);
    const environments::Between rows = environments::between_rows(y, height);
    for (int column = 0; column < width; ++column) {
      out[static_cast<size_t>(row) * width + column] =
          lerp(texels[static_cast<size_t>(rows.low) * width + column],
               texels[static_cast<size_t>(rows.high) * width + column], rows.fraction);
    }
  }
  return out;
}

/// Share of the sphere between rows a and b of n (fractions allowed), times two.
double zone(double a, double b, int n) { return std::cos(M_PI * a / n) - std::cos(M_PI * b / n); }

/// Level of half the rows, and half the columns where texels are not wider than high at the
/// horizon.
EnvironmentLevel halved(const EnvironmentLevel& from, size_t first) {
  const int height = std::max(1, from.height / 2);
  const bool narrow = from.width > 2 * height;
  return {static_cast<uint32_t>(first), narrow ? from.width / 2 : from.width, height};
}
/// Light is conserved: means over the solid angle that a texel covers.
std::vector<Vec3f> reduce(const Vec3f* texels, const EnvironmentLevel& from,
                          const EnvironmentLevel& to) {
  std::vector<Vec3f> out(static_cast<size_t>(to.width) * to.height);
  const double step_x = static_cast<double>(from.width) / to.width,
               step_y = static_cast<double>(from.height) / to.height;
  parallel_for("environment level", to.height, [&](int64_t row) {
    const double top = static_cast<double>(row) * step_y, bottom = top + step_y;
    for (int column = 0; column < to.width; ++column) {
      const double left = column * step_x, right = left + step_x;
      double sum[3] = {0, 0, 0}, total = 0;
      for (int y = static_cast<int>(top); y < std::min<double>(bottom, from.height); ++y) {
        const double high =
            zone(std::max<double>(top, y), std::min<double>(bottom, y + 1), from.height);
        for (int x = static_cast<int>(left); x < std::min<double>(right, from.width); ++x) {
          const double w = high * (std::min<double>(right, x + 1) - std::max<double>(left, x));
          const Vec3f& t = texels[static_cast<size_t>(y) * from.width + x];
          sum[0] += w * t.x, sum[1] += w * t.y, sum[2] += w * t.z, total += w;
        }
      }
      out[static_cast<size_t>(row) * to.width + column] = {static_cast<float>(sum[0] / total),
                                                           static_cast<float>(sum[1] / total),
                                                           static_cast<float>(sum[2] / total)};
    }
  });
  return out;
}

/// Running sum of n weights, 0 to 1, into out[n + 1]; every positive weight takes a positive step.
/// Returns the sum of the weights; all-zero weights leave steps alike.
double running_sum(const double* weights, int n, float* out) {
  double total = 0, padded = 0;
  for (int i = 0; i < n; ++i) total += weights[i];
  const double least = total * kLeastShare;
  for (int i = 0; i < n; ++i) padded += weights[i] > 0 ? weights[i] + least : 0;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    out[i] = total > 0 ? static_cast<float>(sum / padded)
                       : static_cast<float>(static_cast<double>(i) / n);
    sum += weights[i] > 0 ? weights[i] + least : 0;
  }
  // Sums from the last light on are 1 exactly, so that no sample falls on the dark end.
  out[n] = 1;
  for (int i = n; total > 0 && i-- > 0 && !(weights[i] > 0);) out[i] = 1;
  return total;
}

}  // namespace

Result<EnvironmentTable> EnvironmentTable::make(int width, int height,
                                                std::span<const Vec3f> texels,
                                                const std::string& name) {
  GLOAM_TRY_STATUS(check_texels(width, height, texels, name));
  EnvironmentTable table;
  const int k = height < kLeastRows ? (kLeastRows + height - 1) / height | 1 : 1;
  if (k > 1) {
    table.texels_ = add_rows(width, height, texels, k);
  } else {
    table.texels_.assign(texels.begin(), texels.end());
  }
  table.levels_.push_back({0, width, height * k});
  while (table.levels_.back().height > 1) {
    const EnvironmentLevel from = table.levels_.back();
    const EnvironmentLevel to = halved(from, table.texels_.size());
    const std::vector<Vec3f> level = reduce(table.texels_.data() + from.first, from, to);
    table.texels_.insert(table.texels_.end(), level.begin(), level.end());
    table.levels_.push_back(to);
  }

  const int rows = table.levels_[0].height;
  std::vector<double> row_weights(rows);
  table.row_cdf_.resize(rows + 1);
  table.column_cdf_.resize(static_cast<size_t>(rows) * (width + 1));
  parallel_for("environment density", rows, [&](int64_t row) {
    std::vector<double> weights(width);
    for (int column = 0; column < width; ++column) {
      weights[column] = luminance(table.texels_[static_cast<size_t>(row) * width + column]);
    }
    const double sum = running_sum(
        weights.data(), width, table.column_cdf_.data() + static_cast<size_t>(row) * (width + 1));
    row_weights[row] = sum * zone(static_cast<double>(row), static_cast<double>(row) + 1, rows);
  });
  const double total = running_sum(row_weights.data(), rows, table.row_cdf_.data());
  table.illuminance_ = static_cast<float>(total * 2 * M_PI / width);
  if (!(total > 0)) {
    table.row_cdf_.clear();
    table.column_cdf_.clear();
  }
  return table;
}

EnvironmentView EnvironmentTable::view(const Frame& R_WE, float scale) const {
  GLOAM_CHECK(std::isfinite(scale) && scale >= 0,
              "the scale of an environment must be finite and not negative");
  EnvironmentView view;
  view.texels = {texels_.data(), static_cast<uint32_t>(texels_.size())};
  view.levels = {levels_.data(), static_cast<uint32_t>(levels_.size())};
  if (scale > 0 && !row_cdf_.empty()) {
    view.row_cdf = {row_cdf_.data(), static_cast<uint32_t>(row_cdf_.size())};
    view.column_cdf = {column_cdf_.data(), static_cast<uint32_t>(column_cdf_.size())};
  }
  view.R_WE = R_WE;
  view.scale = scale;
  view.illuminance = illuminance_ * scale;
  return view;
}

Frame turned_about_z(float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  return {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
}

}  // namespace gloam
