// Rate of writing a log, beside the plain writes and one fsync of the same bytes, and the time to a
// message in the middle of a large log.
//   log_rate FOLDER [--megabytes N] [--kib N] [--pairs N] [--level N] [--json]
// N megabytes (default 1000) of incompressible messages of N KiB (default 200: JPEGs). Both ways
// in turn, `pairs` times; medians. Seek: open, go to a random time, read the first message, with
// the log's pages taken out of the cache before each; the slowest of 20. FOLDER is on the disk that
// is measured; twice the size is needed there.

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "base/rng.h"
#include "bench/command_line.h"
#include "bench/median.h"
#include "mcap/log_queue.h"
#include "mcap/mcap_reader.h"
#include "mcap/mcap_writer.h"

using namespace gloam;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Arguments {
  fs::path folder;
  int megabytes = 1000, kib = 200, pairs = 3, level = 1;
  bool json = false;
  uint64_t messages() const {
    return uint64_t{1000000} * static_cast<uint64_t>(megabytes) / message_bytes();
  }
  uint64_t message_bytes() const { return uint64_t{1024} * static_cast<uint64_t>(kib); }
};

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Noise, of which messages take windows at different places.
std::vector<uint8_t> make_noise(uint64_t size) {
  std::vector<uint8_t> noise(size);
  const RandomStream stream{1, 1};
  for (uint64_t i = 0; i + 4 <= size; i += 4) {
    const uint32_t v = stream.draw(i, 0).v[0];
    for (uint64_t k = 0; k < 4; ++k) noise[i + k] = static_cast<uint8_t>(v >> (8 * k));
  }
  return noise;
}

std::span<const uint8_t> message_data(const Arguments& a, const std::vector<uint8_t>& noise,
                                      uint64_t number) {
  return std::span<const uint8_t>(noise).subspan(number * 4099 % a.message_bytes(),
                                                 a.message_bytes());
}

Result<double> time_plain(const Arguments& a, const std::vector<uint8_t>& noise) {
  const fs::path path = a.folder / "plain.bin";
  fs::remove(path);
  const auto start = Clock::now();
  GLOAM_TRY(const std::unique_ptr<LogSink> sink, FileSink::create(path));
  for (uint64_t i = 0; i < a.messages(); ++i)
    GLOAM_TRY_STATUS(sink->write(message_data(a, noise, i)));
  GLOAM_TRY_STATUS(sink->sync());
  const double seconds = seconds_since(start);
  GLOAM_TRY_STATUS(sink->close());
  fs::remove(path);
  return seconds;
}

/// Through the queue, as a simulation does.
Result<double> time_log(const Arguments& a, const std::vector<uint8_t>& noise,
                        const fs::path& path) {
  fs::remove(path);
  const auto start = Clock::now();
  GLOAM_TRY(std::unique_ptr<LogSink> sink, FileSink::create(path));
  LogQueue queue(
      std::make_unique<McapWriter>(std::move(sink), McapWriterOptions{.zstd_level = a.level}));
  GLOAM_TRY_STATUS(queue.push(McapChannel{1, 0, "/camera", "cdr", {}}));
  for (uint64_t i = 0; i < a.messages(); ++i) {
    const std::span<const uint8_t> data = message_data(a, noise, i);
    std::vector<uint8_t> buffer = queue.take_buffer();
    buffer.assign(data.begin(), data.end());
    GLOAM_TRY_STATUS(queue.push(
        LogQueueMessage{1, static_cast<uint32_t>(i), 1000000 * i, 1000000 * i, std::move(buffer)}));
  }
  GLOAM_TRY_STATUS(queue.close());
  return seconds_since(start);
}

void drop_from_cache(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return;
  (void)::posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
  ::close(fd);
}

/// Slowest and median seek [ms].
Result<std::pair<double, double>> time_seeks(const Arguments& a, const fs::path& path) {
  std::vector<double> times;
  for (uint64_t k = 0; k < 20; ++k) {
    const uint64_t number = RandomStream{2, 1}.draw(k, 0).v[0] % a.messages();
    drop_from_cache(path);
    const auto start = Clock::now();
    GLOAM_TRY(const McapReader reader, McapReader::open(path));
    McapMessages messages = reader.messages();
    messages.seek(1000000 * number);
    GLOAM_TRY(const McapMessage* message, messages.next());
    times.push_back(1000 * seconds_since(start));
    if (message == nullptr || message->sequence != number)
      return Error{ErrorKind::kIo, "the wrong message was found", {path.string(), 0, 0}, {}};
  }
  return std::pair{*std::max_element(times.begin(), times.end()), median(times)};
}

Status measure(const Arguments& a) {
  const std::vector<uint8_t> noise = make_noise(2 * a.message_bytes());
  const fs::path log = a.folder / "log.mcap";
  std::vector<double> plain, ours, ratios;
  for (int pair = 0; pair < a.pairs; ++pair) {
    GLOAM_TRY(const double p, time_plain(a, noise));
    GLOAM_TRY(const double o, time_log(a, noise, log));
    plain.push_back(p);
    ours.push_back(o);
    ratios.push_back(p / o);
  }
  GLOAM_TRY(const auto seeks, time_seeks(a, log));
  const double megabytes = 1e-6 * static_cast<double>(a.messages() * a.message_bytes());
  std::printf(a.json ? "{\"ratio\": %.4f, \"log_mb_s\": %.1f, \"plain_mb_s\": %.1f, "
                       "\"seek_max_ms\": %.3f, \"seek_median_ms\": %.3f, \"megabytes\": %.0f}\n"
                     : "%.3f of plain writes: %.0f MB/s, plain %.0f MB/s; seek %.1f ms at most, "
                       "median %.1f ms, in %.0f MB\n",
              median(ratios), megabytes / median(ours), megabytes / median(plain), seeks.first,
              seeks.second, megabytes);
  fs::remove(log);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  CommandLine line(argc, argv);
  a.json = line.flag("--json");
  line.value("--megabytes", &a.megabytes);
  line.value("--kib", &a.kib);
  line.value("--pairs", &a.pairs);
  line.value("--level", &a.level, 0);
  a.folder = line.words().empty() ? fs::temp_directory_path() : fs::path(line.words().back());
  return exit_code(measure(a));
}
