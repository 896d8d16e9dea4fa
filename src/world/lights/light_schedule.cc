#include "world/lights/light_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace gloam {
namespace {

constexpr double kEdge = 1e-9;

template <class... Fs>
struct Overloaded : Fs... {
  using Fs::operator()...;
};

struct Draws {
  uint64_t seed;
  uint32_t lamp;

  /// Uniform in [0, 1); `counter` may be negative.
  double operator()(uint32_t stream, int64_t counter) const {
    return RandomStream{seed, stream}.uniform(static_cast<uint64_t>(counter), lamp);
  }
};

double level(const OnOff& p, double time) {
  const double cycles = time / p.period + p.phase + kEdge;
  return cycles - std::floor(cycles) < p.duty + (p.duty < 1 ? 0 : kEdge) ? 1 : 0;
}

double level(const Keyframes& p, double time) {
  const auto after =
      std::upper_bound(p.keys.begin(), p.keys.end(), time, [](double t, const Keyframes::Key& key) {
        return t < key.time - kEdge * std::abs(key.time);
      });
  if (after == p.keys.begin()) return p.keys.front().level;
  const Keyframes::Key& from = after[-1];
  if (!p.linear || after == p.keys.end()) return from.level;
  const double share = std::clamp((time - from.time) / (after->time - from.time), 0.0, 1.0);
  return from.level + share * (after->level - from.level);
}

double level(const MainsRipple& p, double time) {
  // Whole cycles away first: the sine of a large angle loses digits.
  const double cycles = p.frequency * time, s = std::sin(2 * M_PI * (cycles - std::floor(cycles)));
  return 1 - p.depth + 2 * p.depth * s * s;
}

double level(const FluorescentStart& p, double time, const Draws& draw) {
  constexpr uint32_t kStream = stream_id("light.fluorescent_start");
  double begin = p.at + 0.3 + 0.4 * draw(kStream, 0);  // the electrodes are heated
  const int flashes = 1 + static_cast<int>(5 * draw(kStream, 1));
  for (int i = 0; i < flashes; ++i) {
    const int64_t first = 3 * i + 2;
    const double length = 0.03 + 0.05 * draw(kStream, first);
    if (time < begin) return 0;
    if (time < begin + length) return 0.2 + 0.4 * draw(kStream, first + 1);
    begin += length + 0.2 + 0.5 * draw(kStream, first + 2);
  }
  return time < begin ? 0 : 1 - 0.3 * std::exp(-(time - begin) / p.warm_up);
}

/// Noise in -1..1 with the mean 0: uniform draws every 1 / (2 bandwidth) seconds under a cubic
/// B-spline, whose weights sum to one.
double band_noise(double time, double bandwidth, uint32_t stream, const Draws& draw) {
  const double x = time * 2 * bandwidth, base = std::floor(x), t = x - base, u = 1 - t;
  const double weights[4] = {u * u * u / 6, (3 * t * t * t - 6 * t * t + 4) / 6,
                             (3 * u * u * u - 6 * u * u + 4) / 6, t * t * t / 6};
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    sum += weights[i] * (2 * draw(stream, static_cast<int64_t>(base) + i) - 1);
  }
  return sum;
}

double level(const Flame& p, double time, const Draws& draw) {
  // Puffs, and a slower wander.
  const double noise =
      0.5 * band_noise(time, p.bandwidth, stream_id("light.flame.puff"), draw) +
      0.5 * band_noise(time, p.bandwidth / 5, stream_id("light.flame.wander"), draw);
  return 1 + p.depth * noise;
}

double level(const PowerCut& p, double time, const Draws& draw) {
  const auto is_past = [time](double edge) { return time >= edge - kEdge * std::abs(edge); };
  const bool over = std::isfinite(p.until) && is_past(p.until), dark = is_past(p.at) && !over;
  if (p.emergency) return dark ? 1 : 0;
  if (dark) return 0;
  return over && p.starter ? level(FluorescentStart{.at = p.until}, time, draw) : 1;
}

/// Ranges of the parts' values: the first that is wrong.
class Checker {
 public:
  Checker(size_t part, const SourceLoc& loc) : part_(part), loc_(loc) {}

  Checker& positive(const char* name, double x) {
    return need(x > 0 && x <= 1e9, name, x, "positive, up to 1e9");
  }
  Checker& share(const char* name, double x) {
    return need(x >= 0 && x <= 1, name, x, "from 0 to 1");
  }
  Checker& finite(const char* name, double x) {
    return need(std::abs(x) <= 1e9, name, x, "within 1e9");
  }
  Checker& need(bool right, const char* name, double x, const char* range) {
    if (right || !status_.ok()) return *this;
    status_ = Error{ErrorKind::kInput,
                    fmt::format("{} of part {} of a light's schedule is {}; it must be {}", name,
                                part_ + 1, x, range),
                    loc_};
    return *this;
  }
  Status status() const { return status_; }

 private:
  size_t part_;
  SourceLoc loc_;
  Status status_;
};

Checker& check(const Keyframes& p, Checker& c) {
  c.need(!p.keys.empty(), "number of keys", 0, "at least 1");
  for (size_t i = 0; i < p.keys.size(); ++i) {
    c.finite("time of a key", p.keys[i].time);
    c.need(p.keys[i].level >= 0 && p.keys[i].level <= 1e9, "level of a key", p.keys[i].level,
           "from 0 to 1e9");
    c.need(i == 0 || p.keys[i].time > p.keys[i - 1].time, "time of a key", p.keys[i].time,
           "later than the time of the previous key");
  }
  return c;
}

}  // namespace

Status check_schedule(const LightSchedule& schedule, const SourceLoc& loc) {
  for (size_t i = 0; i < schedule.parts.size(); ++i) {
    Checker c(i, loc);
    std::visit(
        Overloaded{
            [&](const OnOff& p) {
              c.positive("period", p.period).share("duty", p.duty).share("phase", p.phase);
            },
            [&](const Keyframes& p) { check(p, c); },
            [&](const MainsRipple& p) {
              c.positive("frequency", p.frequency).share("depth", p.depth);
            },
            [&](const FluorescentStart& p) {
              c.finite("start", p.at).positive("warm-up", p.warm_up);
            },
            [&](const Flame& p) { c.positive("bandwidth", p.bandwidth).share("depth", p.depth); },
            [&](const PowerCut& p) {
              c.finite("start", p.at).need(p.until > p.at, "end", p.until, "later than its start");
            }},
        schedule.parts[i]);
    GLOAM_TRY_STATUS(c.status());
  }
  return {};
}

double light_level(const LightSchedule& schedule, double time, uint64_t seed, uint32_t lamp) {
  const Draws draw{seed, lamp};
  double product = 1;
  for (const LightSchedule::Part& part : schedule.parts) {
    product *=
        std::visit(Overloaded{[&](const FluorescentStart& p) { return level(p, time, draw); },
                              [&](const Flame& p) { return level(p, time, draw); },
                              [&](const PowerCut& p) { return level(p, time, draw); },
                              [&](const auto& p) { return level(p, time); }},
                   part);
  }
  return product;
}

}  // namespace gloam
