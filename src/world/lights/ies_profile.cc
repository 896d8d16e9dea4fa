#include "world/lights/ies_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.h"
#include "base/files.h"
#include "base/plain_text.h"
#include "world/lights/ies_text.h"

namespace gloam {
namespace {

constexpr double kAngleTolerance = 1e-3;  // tolerance for rounded angles [degrees]

bool near(double a, double b) { return std::abs(a - b) < kAngleTolerance; }

/// Finds x among rising `angles`: index of the one below and the weight of the next; false outside.
bool find(const std::vector<double>& angles, double x, size_t* low, double* share) {
  if (x < angles.front() - kAngleTolerance || x > angles.back() + kAngleTolerance) return false;
  *low = 0;
  *share = 0;
  if (angles.size() == 1) return true;
  const auto above = std::upper_bound(angles.begin(), angles.end(), x);
  *low = static_cast<size_t>(std::clamp<ptrdiff_t>(above - angles.begin() - 1, 0,
                                                   static_cast<ptrdiff_t>(angles.size()) - 2));
  *share = std::clamp((x - angles[*low]) / (angles[*low + 1] - angles[*low]), 0.0, 1.0);
  return true;
}

/// As measured, bilinear [cd]; zero outside.
double measured(const IesMeasurement& m, double vertical, double horizontal) {
  size_t v, h;
  double share_v, share_h;
  if (!find(m.vertical, vertical, &v, &share_v)) return 0;
  if (!find(m.horizontal, horizontal, &h, &share_h)) return 0;
  const size_t stride = m.vertical.size();
  const auto at = [&](size_t column) {
    const double* candela = m.candela.data() + column * stride + v;
    return share_v > 0 ? candela[0] + share_v * (candela[1] - candela[0]) : candela[0];
  };
  return share_h > 0 ? at(h) + share_h * (at(h + 1) - at(h)) : at(h);
}

/// Completes the horizontal angles of type C: 0 to 360, or one. Angles that the standard allows to
/// omit are mirror images.
Status complete_c(IesMeasurement* m, const std::string& name) {
  const SourceLoc vertical{name, m->vertical_line, 0}, horizontal{name, m->horizontal_line, 0};
  if (m->vertical.front() < -kAngleTolerance || m->vertical.back() > 180 + kAngleTolerance) {
    return Error{ErrorKind::kInput,
                 fmt::format("vertical angles of type C from {} to {}; 0 to 180 are allowed",
                             m->vertical.front(), m->vertical.back()),
                 vertical};
  }
  std::vector<double>& angles = m->horizontal;
  if (angles.size() == 1) return {};
  const double first = angles.front(), last = angles.back();
  const bool whole = near(first, 0) && last > 180 + kAngleTolerance && last < 360 + kAngleTolerance;
  double mirror = 0;  // angles below it, or above it, are images in this plane
  if (near(first, 0) && near(last, 90)) {
    mirror = 90;
  } else if (near(first, 0) && near(last, 180)) {
    mirror = 180;
  } else if (near(first, 90) && near(last, 270)) {
    mirror = 270;
  } else if (!whole) {
    return Error{ErrorKind::kInput,
                 fmt::format("horizontal angles of type C from {} to {}", first, last), horizontal,
                 "they must go from 0 to 0, 90, 180 or 360, or from 90 to 270"};
  }
  const size_t rows = m->vertical.size();
  const auto append = [&](double angle, size_t column) {
    angles.push_back(angle);
    const std::vector<double> copy(
        m->candela.begin() + static_cast<ptrdiff_t>(column * rows),
        m->candela.begin() + static_cast<ptrdiff_t>((column + 1) * rows));
    m->candela.insert(m->candela.end(), copy.begin(), copy.end());
  };
  const auto reflect = [&](double plane) {
    for (size_t i = angles.size() - 1; i-- > 0;) append(2 * plane - angles[i], i);
  };
  if (mirror == 90) {
    reflect(90);
    reflect(180);
  } else if (mirror > 0) {
    reflect(mirror);  // from 90 to 270 on to 450
  } else if (last < 360 - kAngleTolerance) {
    append(360, 0);
  }
  return {};
}

Status check_flat(const IesMeasurement& m, const std::string& name) {
  const auto fits = [](const std::vector<double>& angles) {
    return near(angles.back(), 90) && (near(angles.front(), -90) || near(angles.front(), 0));
  };
  for (const bool vertical : {true, false}) {
    const std::vector<double>& angles = vertical ? m.vertical : m.horizontal;
    if (fits(angles)) continue;
    return Error{
        ErrorKind::kInput,
        fmt::format("{} angles of type {} from {} to {}", vertical ? "vertical" : "horizontal",
                    m.type == Goniometer::kA ? 'A' : 'B', angles.front(), angles.back()),
        {name, vertical ? m.vertical_line : m.horizontal_line, 0},
        "they must go from -90 to 90, or from 0 to 90 if both sides are alike"};
  }
  return {};
}

/// Towards the direction at `theta` from -Z and `phi` from +X [degrees].
double toward(const IesMeasurement& m, double theta, double phi) {
  if (m.type == Goniometer::kC) {
    if (m.horizontal.size() == 1) return measured(m, theta, m.horizontal[0]);
    return measured(m, theta, phi < m.horizontal.front() - kAngleTolerance ? phi + 360 : phi);
  }
  const double x = std::sin(theta * kDegree) * std::cos(phi * kDegree);
  const double y = std::sin(theta * kDegree) * std::sin(phi * kDegree);
  const double z = -std::cos(theta * kDegree);
  double horizontal = 0, vertical = 0;
  if (m.type == Goniometer::kA) {
    vertical = std::asin(std::clamp(y, -1.0, 1.0)) / kDegree;
    horizontal = std::atan2(x, -z) / kDegree;
  } else {
    horizontal = std::asin(std::clamp(x, -1.0, 1.0)) / kDegree;
    vertical = std::atan2(y, -z) / kDegree;
  }
  if (near(m.vertical.front(), 0)) vertical = std::abs(vertical);
  if (near(m.horizontal.front(), 0)) horizontal = std::abs(horizontal);
  return measured(m, vertical, horizontal);
}

/// Coarsest spacing of the grid that holds all measured angles [degrees]; the finest where none
/// does.
double spacing(const std::vector<double>& angles) {
  for (const double step : {5.0, 2.5, 1.0, 0.5}) {
    const auto on_grid = [&](double a) { return near(std::remainder(a, step), 0); };
    if (std::all_of(angles.begin(), angles.end(), on_grid)) return step;
  }
  return 0.25;
}

/// Integral over the sphere of the grid, linear in the polar angle between rows.
double flux_of(const IesProfile& p) {
  const double step = M_PI / (p.rows - 1);
  double flux = 0;
  for (int row = 0; row < p.rows; ++row) {
    // Weight: integral of the linear tent of one row times the sine.
    const double at = step * row, bend = (1 - std::cos(step)) / step;
    double weight = 2 * bend * std::sin(at);
    if (row == 0 || row == p.rows - 1) weight = 1 - std::sin(step) / step;
    double ring = 0;
    for (int column = 0; column < p.columns; ++column) {
      ring += p.candela[static_cast<size_t>(row) * p.columns + column];
    }
    flux += weight * ring / p.columns * 2 * M_PI;
  }
  return flux;
}

}  // namespace

float IesProfile::intensity(Vec3f d_L) const {
  return ies_intensity(candela.data(), rows, columns, d_L);
}

Result<IesProfile> parse_ies(std::string_view text, const std::string& name) {
  GLOAM_TRY(IesMeasurement m, read_ies_text(text, name));
  double step_theta = 1, step_phi = 1;  // types A and B: their grid lies across this one
  bool around = false;
  if (m.type == Goniometer::kC) {
    GLOAM_TRY_STATUS(complete_c(&m, name));
    step_theta = spacing(m.vertical);
    step_phi = spacing(m.horizontal);
    around = m.horizontal.size() == 1;
  } else {
    GLOAM_TRY_STATUS(check_flat(m, name));
  }
  IesProfile out;
  out.rows = static_cast<int>(std::lround(180 / step_theta)) + 1;
  out.columns = around ? 1 : static_cast<int>(std::lround(360 / step_phi));
  for (int row = 0; row < out.rows; ++row) {
    for (int column = 0; column < out.columns; ++column) {
      out.candela.push_back(static_cast<float>(toward(m, row * step_theta, column * step_phi)));
    }
  }
  out.most = *std::max_element(out.candela.begin(), out.candela.end());
  out.flux = flux_of(out);
  return out;
}

Result<IesProfile> read_ies(const std::filesystem::path& path) {
  GLOAM_TRY(const std::string text, read_plain_text(path, uint64_t{16} << 20));
  return parse_ies(text, path.string());
}

}  // namespace gloam
