#include "runtime/streams/sensor_costs.h"

#include <algorithm>
#include <utility>

namespace gloam {
namespace {

// A bridge opens a stream whenever somebody subscribes: of those that are closed, the oldest are
// forgotten.
constexpr size_t kMostAccounts = 64;

}  // namespace

SensorAccount::SensorAccount(std::string name, double rate) {
  cost_.name = std::move(name);
  cost_.rate = rate;
}

void SensorAccount::add_message(double time) {
  const std::lock_guard lock(mutex_);
  // A reset takes the time back.
  if (cost_.messages++ > 0) span_ += std::max(time - last_, 0.0);
  last_ = time;
}

void SensorAccount::add_time(double seconds, double waited) {
  const std::lock_guard lock(mutex_);
  seconds_ += seconds;
  waited_ += waited;
}

void SensorAccount::set_dropped(int64_t dropped) {
  const std::lock_guard lock(mutex_);
  cost_.dropped = dropped;
}

SensorCost SensorAccount::cost() const {
  const std::lock_guard lock(mutex_);
  SensorCost cost = cost_;
  const auto messages = static_cast<double>(std::max<int64_t>(1, cost.messages));
  cost.wall_ms = 1e3 * std::max(0.0, seconds_ - waited_) / messages;
  cost.waited_ms = 1e3 * waited_ / messages;
  if (span_ > 0) cost.achieved = (messages - 1) / span_;
  return cost;
}

std::shared_ptr<SensorAccount> SensorCosts::open(std::string name, double rate) {
  auto account = std::make_shared<SensorAccount>(std::move(name), rate);
  const std::lock_guard lock(mutex_);
  if (accounts_.size() >= kMostAccounts) {
    const auto closed =
        std::ranges::find_if(accounts_, [](const auto& one) { return one.use_count() == 1; });
    if (closed != accounts_.end()) accounts_.erase(closed);
  }
  accounts_.push_back(account);
  return account;
}

std::vector<SensorCost> SensorCosts::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<SensorCost> costs;
  for (const auto& account : accounts_) costs.push_back(account->cost());
  return costs;
}

double rate_of(const std::function<int64_t(int64_t step)>& due, Rational timestep) {
  constexpr double kRateWindow = 10;  // [s]
  const auto end = static_cast<int64_t>(kRateWindow / timestep.value());
  int64_t count = 0;
  for (int64_t step = due(0); step < end; step = due(step + 1)) ++count;
  return static_cast<double>(count) / kRateWindow;
}

}  // namespace gloam
