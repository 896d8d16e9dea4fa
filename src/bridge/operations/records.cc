// Operator: logs, pictures and checkpoints.

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <ctime>

#include "bridge/operations/operator_private.h"

namespace gloam::bridge {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostCheckpoints = 64;
constexpr auto kLongestPicture = std::chrono::seconds(120);

// A file's name without folders; empty = by date and time.
Result<std::string> log_name(const std::string& asked) {
  if (asked.empty())
    return fmt::format("{:%Y-%m-%d_%H%M%S}.mcap", fmt::localtime(std::time(nullptr)));
  const bool plain =
      asked.size() <= 100 && asked[0] != '.' && std::ranges::all_of(asked, [](unsigned char c) {
        return std::isalnum(c) || c == '_' || c == '-' || c == '.';
      });
  if (!plain)
    return Error{ErrorKind::kInput,
                 "the name of a log may contain only letters, digits, '_', '-' and '.'"};
  return asked.ends_with(".mcap") ? asked : asked + ".mcap";
}

Error no_checkpoint(int64_t id) {
  return Error{ErrorKind::kInput, fmt::format("there is no checkpoint {}", id)};
}

}  // namespace

void Operator::set_recording_folder(fs::path folder) {
  const std::lock_guard lock(private_->records_mutex);
  private_->recording_folder = std::move(folder);
}

Result<std::string> Operator::start_recording(const std::string& name, const LogRequest& request) {
  Private& p = *private_;
  GLOAM_TRY(const std::string file, log_name(name));
  const std::lock_guard lock(p.records_mutex);
  if (p.log != nullptr)
    return Error{ErrorKind::kUsage, fmt::format("'{}' is already being recorded", p.log_file)};
  std::error_code code;
  fs::create_directories(p.recording_folder, code);
  LogRequest log = request;
  log.file = fs::absolute(p.recording_folder, code) / file;
  log.overwrite = false;
  log.required = false;
  GLOAM_TRY(p.log, start_log(simulation_, log));
  p.log_file = log.file.string();
  return p.log_file;
}

Result<std::string> Operator::stop_recording() {
  Private& p = *private_;
  const std::lock_guard lock(p.records_mutex);
  if (p.log == nullptr) return Error{ErrorKind::kUsage, "no log is being recorded"};
  const std::unique_ptr<LogStream> log = std::move(p.log);
  GLOAM_TRY_STATUS(log->finish());
  return p.log_file;
}

Result<std::shared_ptr<const CameraFrame>> Operator::picture(CameraRequest request) {
  struct Waiting {
    std::mutex mutex;
    std::condition_variable changed;
    std::shared_ptr<const CameraFrame> frame;
    std::optional<Error> error;
  };
  const auto waiting = std::make_shared<Waiting>();
  request.required = false;
  request.is_view = true;
  request.on_end = [waiting](const Error& error) {
    const std::lock_guard lock(waiting->mutex);
    waiting->error = error;
    waiting->changed.notify_all();
  };
  GLOAM_TRY(const std::unique_ptr<CameraStream> stream,
            simulation_.open_camera(request, [waiting](std::shared_ptr<const CameraFrame> frame) {
              const std::lock_guard lock(waiting->mutex);
              if (waiting->frame == nullptr) waiting->frame = std::move(frame);
              waiting->changed.notify_all();
            }));
  const auto end = std::chrono::steady_clock::now() + kLongestPicture;
  std::unique_lock lock(waiting->mutex);
  while (waiting->frame == nullptr && !waiting->error && std::chrono::steady_clock::now() < end) {
    lock.unlock();
    if (simulation_.paused()) stream->refresh();
    lock.lock();
    waiting->changed.wait_for(lock, std::chrono::seconds(1), [&] {
      return waiting->frame != nullptr || waiting->error.has_value();
    });
  }
  if (waiting->frame != nullptr) return waiting->frame;
  if (waiting->error) return *waiting->error;
  return Error{ErrorKind::kIo, "rendering the image took longer than two minutes"};
}

Result<int64_t> Operator::save_checkpoint() {
  Private& p = *private_;
  GLOAM_TRY_STATUS(p.need_world());
  GLOAM_TRY(Checkpoint checkpoint, simulation_.checkpoint());
  const std::lock_guard lock(p.records_mutex);
  if (p.kept.size() >= kMostCheckpoints)
    return Error{ErrorKind::kUsage,
                 "the limit of 64 checkpoints has been reached",
                 {},
                 "forget some of them"};
  p.kept.emplace(p.next_checkpoint, std::move(checkpoint));
  return p.next_checkpoint++;
}

Status Operator::restore_checkpoint(int64_t id) {
  Private& p = *private_;
  std::optional<Checkpoint> checkpoint;
  {
    const std::lock_guard lock(p.records_mutex);
    const auto found = p.kept.find(id);
    if (found == p.kept.end()) return no_checkpoint(id);
    checkpoint = found->second;
  }
  const std::lock_guard one_at_a_time(p.change_mutex);
  GLOAM_TRY_STATUS(simulation_.restore(*checkpoint));
  p.unloaded = false;
  p.rests = false;
  const std::lock_guard lock(p.names_mutex);
  p.waiting.clear();
  return {};
}

Status Operator::forget_checkpoint(int64_t id) {
  const std::lock_guard lock(private_->records_mutex);
  if (private_->kept.erase(id) == 0) return no_checkpoint(id);
  return {};
}

std::vector<std::pair<int64_t, Checkpoint>> Operator::checkpoints() const {
  const std::lock_guard lock(private_->records_mutex);
  return {private_->kept.begin(), private_->kept.end()};
}

}  // namespace gloam::bridge
