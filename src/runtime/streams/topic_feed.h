#pragma once
// TopicFeed: the topics that a reader asked for, out of the streams of a simulation. One stream of
// a camera serves all topics of it; what nobody asked for is neither rendered nor encoded.

#include <map>
#include <memory>
#include <mutex>
#include <vector>

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
  int64_t dropped() const override;
  int64_t complete_at(int64_t) const override { return -1; }
  void flush() override;
  Status status() const override;
  /// The cameras that render its images; they live as long as this feed.
  const std::vector<LiveCamera*>& cameras() const { return cameras_; }

 private:
  TopicFeed(TopicTables& tables, const TopicRequest& request, TopicCallback on_message, int batch)
      : tables_(tables), request_(request), on_message_(std::move(on_message)), batch_(batch) {}

  /// A topic and the room for its messages.
  struct Outlet {
    const Topic* topic;
    StepSchedule schedule = {};
    StepSchedule messages = {};          // of a topic that is sampled more often than it is sent
    int64_t sampled = -1;                // step
    FrameEncoder encode_frame = {};      // of a camera's topic
    InstantEncoder encode_instant = {};  // of a topic of instants
    MessageBytes bytes = {};
  };
  using Outlets = std::vector<Outlet>;
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

  Status open_all(LiveSimulation& simulation);
  Status open_camera(LiveSimulation& simulation, const std::string& camera, Outlets outlets);
  Status open_lidar(LiveSimulation& simulation, const std::string& lidar, Outlets outlets);
  Status open_sensors(LiveSimulation& simulation, Outlets outlets);
  Status open_sensor_stream(LiveSimulation& simulation, std::vector<Gathering*> gatherings,
                            SampleSteps steps);
  Status open_snapshots(LiveSimulation& simulation, Outlets outlets);
  Status open_latched(LiveSimulation& simulation, Outlets outlets);
  Status send_latched(LiveSimulation& simulation, const Snapshot& now);
  void take_sample(Gathering* gathering, size_t part, const SensorMessage& message);
  static bool is_message(Outlet* outlet, int64_t step);
  Status take_instant(InstantReader* reader, const Snapshot& now);
  Status follow(const std::shared_ptr<const CompiledWorld>& world, InstantReader* reader);
  static void keep_topics(const TopicTable& table, Outlets* outlets);
  void note(const std::string& what, const Status& fault);
  void send(Outlet* outlet, const Status& encoded, TopicMessage message);

  TopicTables& tables_;
  std::shared_ptr<const TopicTable> table_;  // of the World at the opening
  const TopicRequest request_;
  TopicCallback on_message_;
  const int batch_;
  Outlets latched_outlets_;
  std::shared_ptr<const TopicTable> latched_table_;  // theirs
  std::shared_ptr<LatchedTopics> latched_;           // null = there are none
  std::mutex sensors_mutex_;                         // guards the gatherings
  std::vector<std::unique_ptr<Gathering>> gatherings_;
  mutable std::mutex mutex_;  // guards the first fault
  Status fault_;
  std::vector<LiveCamera*> cameras_;              // of streams_
  std::vector<std::unique_ptr<Stream>> streams_;  // last: they use the others
};

}  // namespace gloam
