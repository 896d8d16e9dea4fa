#include "studio/inspector.h"

#include <algorithm>
#include <utility>

#include "studio/fields.h"
#include "studio/replies.h"
#include "studio/state_key.h"

namespace gloam::studio {
namespace {

constexpr size_t kMaxDataRequests = 256;
constexpr std::chrono::milliseconds kWatchTick{20};

}  // namespace

Inspector::Inspector(Simulation& simulation, Outputs outputs)
    : simulation_(simulation), outputs_(std::move(outputs)) {}

Inspector::~Inspector() { stop(); }

void Inspector::start() {
  thread_ = std::thread([this] { run(); });
}

bool Inspector::post(int64_t client, const ControlMessage& message) {
  {
    const std::lock_guard lock(mutex_);
    if (requests_.size() >= kMaxDataRequests) return false;
    requests_.push_back({client, message});
  }
  wake_.notify_one();
  return true;
}

void Inspector::forget(int64_t client) {
  const std::lock_guard lock(mutex_);
  gone_.push_back(client);
}

void Inspector::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void Inspector::run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (watchers_.empty()) {
      wake_.wait(lock, [this] { return stopping_ || !requests_.empty(); });
    } else {
      wake_.wait_for(lock, kWatchTick, [this] { return stopping_ || !requests_.empty(); });
    }
    const std::deque<Request> requests = std::exchange(requests_, {});
    const std::vector<int64_t> gone = std::exchange(gone_, {});
    lock.unlock();
    for (const Request& request : requests) answer(request);
    for (const int64_t client : gone) watchers_.erase(client);
    serve_watchers();
    lock.lock();
  }
}

void Inspector::answer(const Request& request) {
  std::visit(
      [&](const auto& message) {
        if constexpr (requires { do_message(request.client, message); })
          do_message(request.client, message);
      },
      request.message);
}

/// Solves the instant that clients look at, unless it is the last one.
bool Inspector::look() {
  const Snapshot shown = outputs_.shown();
  if (!shown) return false;
  if (snapshot_ && &snapshot_.data() == &shown.data()) return true;
  snapshot_ = {};
  if (!instant_.solve(shown).ok()) return false;
  snapshot_ = shown;
  ++looks_;
  return true;
}

void Inspector::do_message(int64_t client, const DescribeMessage&) {
  outputs_.text(client, model_message(simulation_.world()));
}

void Inspector::do_message(int64_t client, const GetMessage& message) {
  if (!look())
    return outputs_.text(client, notice_message("The state of the simulation is not available."));
  FieldsMessage fields = encode_fields(message.fields, message.id, snapshot_, instant_);
  report(client, fields.problems);
  outputs_.reply(client, std::move(fields.bytes));
}

void Inspector::do_message(int64_t client, const WatchMessage& message) {
  if (message.fields.empty()) {
    watchers_.erase(client);
  } else {
    watchers_[client] = {.wish = message, .due = Clock::now()};
  }
}

void Inspector::do_message(int64_t client, const CopyStateMessage&) {
  if (look()) outputs_.text(client, copied_message(to_mjcf(key_of(instant_))));
}

void Inspector::serve_watchers() {
  const auto now = Clock::now();
  const auto is_due = [&](const auto& entry) { return now >= entry.second.due; };
  if (std::ranges::none_of(watchers_, is_due) || !look()) return;
  for (auto& [client, watcher] : watchers_) {
    if (now < watcher.due || watcher.seen == looks_) continue;
    watcher.due = now + std::chrono::duration_cast<Clock::duration>(
                            std::chrono::duration<double>(1 / watcher.wish.rate));
    watcher.seen = looks_;
    FieldsMessage fields = encode_fields(watcher.wish.fields, 0, snapshot_, instant_);
    if (!std::exchange(watcher.has_warned, true)) report(client, fields.problems);
    outputs_.watched(client, std::move(fields.bytes));
  }
}

void Inspector::report(int64_t client, const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) outputs_.text(client, notice_message(problem));
}

}  // namespace gloam::studio
