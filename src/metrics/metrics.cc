#include "metrics/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/log.h"
#include "base/text.h"
#include "gloam/world.h"

namespace gloam {
namespace {

std::string prefix_of(const RobotInstance& robot) {
  return robot.name.empty() ? "" : robot.name + ".";
}

std::vector<int> robots_like(const CompiledWorld& world, const std::string& pattern) {
  std::vector<int> fitting;
  for (size_t i = 0; i < world.robots.size(); ++i) {
    const std::string& name = world.robots[i].name;
    if (name == pattern || fits_pattern(pattern, name)) fitting.push_back(static_cast<int>(i));
  }
  return fitting;
}

Error no_such_robot(const CompiledWorld& world, const std::string& what, const std::string& pattern,
                    const SourceLoc& loc) {
  std::vector<std::string> names;
  for (const RobotInstance& robot : world.robots) names.push_back(robot.name);
  return {ErrorKind::kInput, fmt::format("{}: there is no robot '{}'", what, pattern), loc,
          suggest_name(pattern, names)};
}

}  // namespace

Result<std::unique_ptr<Metrics>> Metrics::make(const CompiledWorld& world, MetricProbes probes) {
  std::unique_ptr<Metrics> metrics(new Metrics);
  metrics->probes_ = std::move(probes);
  metrics->readings_ = ProbeReadings(metrics->probes_.sources);
  metrics->columns_.emplace_back("time_s");
  for (const GoalOptions& goal : world.scene.goals) {
    if (robots_like(world, goal.robot).empty())
      return no_such_robot(world, "[[goal]]", goal.robot, goal.loc);
  }
  std::vector<BuiltinColumn> builtin;
  metrics->robots_.reserve(world.robots.size());
  for (size_t i = 0; i < world.robots.size(); ++i)
    metrics->add_robot(world, static_cast<int>(i), &builtin);
  GLOAM_TRY_STATUS(metrics->add_declared(world, builtin));
  metrics->row_.assign(metrics->columns_.size(), 0);
  metrics->light_.assign(world.robots.size(), 0);
  metrics->begin_episode();
  return metrics;
}

void Metrics::add_robot(const CompiledWorld& world, int index,
                        std::vector<BuiltinColumn>* builtin) {
  const MetricRobot& robot = robots_.emplace_back(describe_robot(world, index, probes_));
  if (robot.root() <= 0) return;
  const std::string prefix = prefix_of(*robot.instance);
  for (const RobotMetricFactory make : robot_metrics()) {
    Family family{make(robot), prefix, columns_.size(), 0};
    if (family.metric == nullptr) continue;
    for (const MetricColumn& column : family.metric->columns()) {
      builtin->push_back({column.name, index, static_cast<int>(columns_.size())});
      columns_.push_back(with_unit(prefix + column.name, column.unit));
      infos_.push_back({columns_.back(), column.unit, robot.instance->name, false});
      ++family.count;
    }
    families_.push_back(std::move(family));
  }
}

Status Metrics::add_declared(const CompiledWorld& world,
                             const std::vector<BuiltinColumn>& builtin) {
  std::set<std::string> taken(columns_.begin(), columns_.end());
  for (const MetricOptions& options : world.scene.metrics) {
    const double most = world.scene.record.metrics_rate.value();
    if (options.rate && options.rate->value() > most)
      return Error{
          ErrorKind::kInput,
          fmt::format("metric '{}' has a rate of {:g} Hz, but metrics are evaluated at {:g} Hz",
                      options.name, options.rate->value(), most),
          options.loc, "increase 'metrics_rate' of [record]"};
    std::vector<int> robots = {-1};
    if (!options.robots.empty()) robots = robots_like(world, options.robots);
    if (robots.empty())
      return no_such_robot(world, fmt::format("metric '{}'", options.name), options.robots,
                           options.loc);
    for (const int robot : robots) {
      GLOAM_TRY_STATUS(add_declared_of(options, world, builtin, robot));
      if (!taken.insert(columns_.back()).second)
        return Error{ErrorKind::kInput,
                     fmt::format("there are two metrics named '{}'", columns_.back()), options.loc,
                     "rename one of them"};
    }
  }
  return {};
}

Status Metrics::add_declared_of(const MetricOptions& options, const CompiledWorld& world,
                                const std::vector<BuiltinColumn>& builtin, int robot) {
  GLOAM_TRY(DeclaredMetric metric, DeclaredMetric::make(options, world, builtin, robot));
  columns_.push_back(metric.column());
  infos_.push_back({columns_.back(), options.unit,
                    robot < 0 ? "" : world.robots[static_cast<size_t>(robot)].name, true});
  for (const QuantityReader& reader : metric.readers())
    if (reader.probe >= 0) readings_.add(reader.probe);
  declared_.push_back(std::move(metric));
  return {};
}

std::vector<Metrics::Plot> Metrics::plots() const {
  for (const MetricRobot& robot : robots_) {
    if (robot.base < 0 || robot.instance->options.controller.goals.empty()) continue;
    const std::string prefix = prefix_of(*robot.instance);
    const auto plot = [&](const char* title, const char* unit, const std::string& name) {
      return Plot{title, unit, with_unit(prefix + name, unit),
                  with_unit(prefix + name + "_goal", unit)};
    };
    return {plot("forward speed", "m/s", "vx"), plot("sideways speed", "m/s", "vy"),
            plot("turn rate", "rad/s", "yaw_rate")};
  }
  return {};
}

void Metrics::begin_episode() {
  samples_ = 0;
  present_ = {};
  for (Family& family : families_) family.metric->begin_episode();
  for (DeclaredMetric& metric : declared_) metric.begin_episode();
}

const std::vector<double>& Metrics::sample(const Snapshot& snapshot) {
  if (samples_ > 0 && run_ != snapshot.data().run) {
    ended_.push_back(present_episode());
    begin_episode();
  }
  run_ = snapshot.data().run;
  std::ranges::fill(row_, std::numeric_limits<double>::quiet_NaN());
  row_[0] = snapshot.time();
  MetricInstant instant;
  if (!families_.empty() || !declared_.empty()) {
    const Status solved = instant_.solve(snapshot);
    if (!solved.ok()) {
      if (!told_failure_)
        log_warning("metrics at t = {} s are missing: {}", snapshot.time(),
                    solved.error().to_string());
      told_failure_ = true;
      return row_;
    }
    instant_.contacts(&contacts_);
    measure_light(snapshot);
    readings_.follow(snapshot);
    instant = {&snapshot,
               instant_.model(),
               instant_.data(),
               contacts_,
               samples_ > 0 ? snapshot.time() - present_.duration : 0,
               light_,
               row_,
               &readings_};
  }
  const std::span<double> row(row_);
  for (Family& family : families_)
    family.metric->sample(instant, row.subspan(family.first, family.count));
  size_t column = row_.size() - declared_.size();
  for (DeclaredMetric& metric : declared_) row_[column++] = metric.sample(instant);
  present_.steps = snapshot.step();
  present_.duration = snapshot.time();
  present_.hash = snapshot.hash();
  ++samples_;
  return row_;
}

// One pass for all robots: each costs the poses of everything.
void Metrics::measure_light(const Snapshot& snapshot) {
  if (probes_.illuminance == nullptr || samples_ % probes_.light_every != 0) return;
  std::vector<Vec3> places;
  std::vector<size_t> rows;
  for (size_t i = 0; i < robots_.size(); ++i) {
    if (robots_[i].base < 0) continue;
    const JointState base = snapshot[Joint{robots_[i].base, 0}];
    // Over all of it: it casts no shadow there.
    places.push_back({base.qpos[0], base.qpos[1], base.qpos[2] + robots_[i].reach});
    rows.push_back(i);
  }
  if (places.empty()) return;
  const std::vector<double> light = probes_.illuminance(snapshot, places);
  for (size_t k = 0; k < rows.size(); ++k) light_[rows[k]] = light[k];
}

std::vector<MetricNumber> Metrics::summary() const {
  std::vector<MetricNumber> numbers;
  for (const Family& family : families_) {
    const size_t first = numbers.size();
    family.metric->summarize(&numbers);
    for (size_t i = first; i < numbers.size(); ++i)
      numbers[i].first = family.prefix + numbers[i].first;
  }
  for (const DeclaredMetric& metric : declared_) metric.summarize(&numbers);
  return numbers;
}

Metrics::Episode Metrics::present_episode() const {
  Episode episode = present_;
  episode.results = summary();
  return episode;
}

std::vector<Metrics::Episode> Metrics::episodes() const {
  std::vector<Episode> all = ended_;
  all.push_back(present_episode());
  return all;
}

std::vector<std::pair<std::string, int64_t>> Metrics::missing() const {
  std::vector<std::pair<std::string, int64_t>> columns;
  for (const DeclaredMetric& metric : declared_)
    if (metric.missing() > 0) columns.emplace_back(metric.column(), metric.missing());
  return columns;
}

bool metrics_name(const Scene& scene, std::string_view word) {
  return std::ranges::any_of(scene.metrics, [&](const MetricOptions& metric) {
    return metric.value.find(word) != std::string::npos;
  });
}

Result<std::vector<MetricInfo>> World::metrics() const {
  MetricProbes probes;  // that columns are there for; nothing is sampled
  if (compiled_->scene.weather || !compiled_->scene.volumes.empty() ||
      !compiled_->scene.gases.empty() || metrics_name(compiled_->scene, "visibility"))
    probes.visibility = [](const SnapshotData&, Vec3f) { return 0.0; };
  probes.illuminance = [](const Snapshot&, const std::vector<Vec3>& places) {
    return std::vector<double>(places.size());
  };
  GLOAM_TRY(const auto metrics, Metrics::make(*compiled_, std::move(probes)));
  return metrics->infos();
}

}  // namespace gloam
