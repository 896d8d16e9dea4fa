#include "metrics/probe_readings.h"

#include <algorithm>
#include <limits>

#include "base/log.h"
#include "scene/options/probe_quantities.h"
#include "world/world.h"

namespace gloam {

void ProbeReadings::add(int row) {
  if (std::ranges::find(entries_, row, &Entry::row) == entries_.end())
    entries_.push_back({.row = row});
}

void ProbeReadings::open(const Snapshot& snapshot) {
  const std::shared_ptr<const CompiledWorld>& world = snapshot.data().world;
  instant_ = std::make_unique<ProbeInstant>(world);
  for (Entry& entry : entries_) {
    const ProbeDescription& probe = world->probes[static_cast<size_t>(entry.row)];
    entry.schedule =
        StepSchedule::at_most(probe.options.rate, exact_rational(snapshot.data().timestep));
    entry.numbers.assign(static_cast<size_t>(probe.quantity->count()),
                         std::numeric_limits<double>::quiet_NaN());
    Result<ProbeReader> reader = make_probe_reader(probe, {world, sources_});
    if (reader.ok())
      entry.read = *std::move(reader);
    else
      tell(entry, reader.error());
  }
}

void ProbeReadings::tell(const Entry& entry, const Error& error) {
  if (!has_told_)
    log_warning("metrics of probe '{}' are missing: {}",
                instant_->world().probes[static_cast<size_t>(entry.row)].options.name,
                error.to_string());
  has_told_ = true;
}

void ProbeReadings::follow(const Snapshot& snapshot) {
  if (entries_.empty()) return;
  if (instant_ == nullptr) open(snapshot);
  instant_->follow(snapshot);
  const bool began_anew = snapshot.step() < last_;
  last_ = snapshot.step();
  for (Entry& entry : entries_) {
    if (began_anew) entry.next = 0;
    if (!entry.read || last_ < entry.next) continue;
    entry.next = entry.schedule.step_of(entry.schedule.first_at_or_after(last_ + 1));
    const Status read = entry.read(*instant_, entry.numbers);
    if (read.ok()) continue;
    std::ranges::fill(entry.numbers, std::numeric_limits<double>::quiet_NaN());
    tell(entry, read.error());
  }
}

std::span<const double> ProbeReadings::numbers(int row) const {
  return std::ranges::find(entries_, row, &Entry::row)->numbers;
}

}  // namespace gloam
