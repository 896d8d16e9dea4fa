#pragma once
// TopicFeed: the topics that one reader asked for, from the streams of a simulation. One stream of
// a camera serves all of its topics; topics without readers are neither rendered nor encoded.

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "base/threads/stream_set.h"
#include "gloam/simulation.h"
#include "runtime/streams/latched_topics.h"
#include "runtime/streams/topic_tables.h"
#include "sim/loop/step_schedule.h"

namespace gloam {

class LiveCamera;
class LiveSimulation;

class TopicFeed final : public TopicStream {
 public:
  /// `batch`: of topics of instants and of sensors, as SubscriptionOptions::batch, 1 … 64. Errors:
  /// no such topic, an input, those of the streams.
  static Result<std::unique_ptr<TopicFeed>> open(LiveSimulation& simulation, TopicTables& tables,
                                                 const TopicRequest& request,
                                                 TopicCallback on_message, int batch = 1);
  ~TopicFeed() override;
  Status set_topics(std::span<const std::string> names) override;
  int64_t dropped() const override { return streams_.dropped(); }
  int64_t complete_at(int64_t) const override { return -1; }
  void flush() override;
  Status status() const override;
  /// The cameras that render its images; they live until set_topics() or the end of this feed.
  std::vector<LiveCamera*> cameras() const;

 private:
  TopicFeed(LiveSimulation& simulation, TopicTables& tables, const TopicRequest& request,
            TopicCallback on_message, int batch)
      : simulation_(simulation),
        tables_(tables),
        request_(request),
        on_message_(std::move(on_message)),
        batch_(batch) {}

  using TopicPointer = std::shared_ptr<const Topic>;  // keeps its table
  using TopicsByStream = std::map<std::string, std::vector<TopicPointer>>;
  /// A topic and the state of its messages.
  struct Outlet {
    TopicPointer topic;
    StepSchedule schedule = {};
    StepSchedule messages = {};          // of a topic that is sampled more often than it is sent
    int64_t sampled = -1;                // step
    FrameEncoder encode_frame = {};      // of a camera's topic
    InstantEncoder encode_instant = {};  // of a topic of instants
    MessageBytes bytes = {};
  };
  using Outlets = std::vector<Outlet>;
  /// Topics by the kind of their stream.
  struct Wanted {
    TopicsByStream cameras, lidars;
    std::vector<TopicPointer> sensors, instants, latched;
  };
  /// The stream of a camera or LiDAR and its topics, which the thread of the stream reads.
  struct Part {
    std::mutex mutex;  // guards the outlets
    Outlets outlets;
    Rational rate = {0, 1};  ///< of the camera's pictures [Hz]
    std::atomic<LiveCamera*> camera{nullptr};
  };
  using Parts = std::map<std::string, Part>;
  /// Samples of the sensors of one topic by step, until all of a step are there.
  struct Gathering {
    struct Samples {
      std::vector<SensorMessage> messages;
      size_t count = 0;
    };
    Outlet outlet;
    std::map<int64_t, Samples> by_step;
  };
  enum class SampleSteps : uint8_t { kAll, kUsed };
  /// Where samples of a sensor go.
  struct SampleSlot {
    Gathering* gathering = nullptr;
    size_t part = 0;
  };
  /// Topics of instants, of the World whose Snapshots come.
  struct InstantReader {
    Outlets outlets;
    std::shared_ptr<const TopicTable> table;
    std::unique_ptr<PoseSolver> solver;
    TopicInstant::Performance performance;
  };

  static Result<Wanted> find_wanted(const std::shared_ptr<const TopicTable>& table,
                                    std::span<const std::string> names);
  Outlet make_outlet(const TopicPointer& topic) const;
  Outlets change(Outlets outlets, const std::vector<TopicPointer>& topics) const;
  void close_unwanted(Parts* parts, const char* kind, const TopicsByStream& wanted);
  Status set_camera(const std::string& camera, const std::vector<TopicPointer>& topics);
  Status open_camera(const std::string& camera, std::vector<std::string> outputs, Part* part);
  Status set_lidar(const std::string& lidar, const std::vector<TopicPointer>& topics);
  Status set_sensors(const std::vector<TopicPointer>& topics);
  Status open_sensor_stream(std::vector<Gathering*> gatherings, SampleSteps steps);
  Status set_instants(const std::vector<TopicPointer>& topics);
  Status set_latched(const std::shared_ptr<const TopicTable>& table,
                     const std::vector<TopicPointer>& topics);
  Status send_latched(Outlets* outlets, const Snapshot& now);
  Status send_latched_again(const Snapshot& now);
  void take_sample(Gathering* gathering, size_t part, const SensorMessage& message);
  static bool is_message(Outlet* outlet, int64_t step);
  Status take_instant(InstantReader* reader, const Snapshot& now);
  Status follow(const std::shared_ptr<const CompiledWorld>& world, InstantReader* reader);
  static void keep_topics(const std::shared_ptr<const TopicTable>& table, Outlets* outlets);
  void note(const std::string& what, const Status& fault);
  void send(Outlet* outlet, const Status& encoded, TopicMessage message);

  LiveSimulation& simulation_;
  TopicTables& tables_;
  const TopicRequest request_;
  TopicCallback on_message_;
  const int batch_;
  Outlets latched_outlets_;
  std::shared_ptr<const TopicTable> latched_table_;  // theirs
  std::shared_ptr<LatchedTopics> latched_;           // null = there are none
  std::mutex sensors_mutex_;                         // guards the gatherings
  std::vector<std::unique_ptr<Gathering>> gatherings_;
  bool has_sensors_ = false;  // the streams of the gatherings are open
  std::vector<std::string> instant_names_;
  InstantReader instants_;
  mutable std::mutex mutex_;  // guards the first fault
  Status fault_;
  Parts cameras_, lidars_;
  StreamSet streams_;  // last: they use the others
};

}  // namespace gloam
