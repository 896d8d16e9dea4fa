// Topic of a run's metrics. They count from the moment that the topic is opened.

#include "metrics/metrics.h"
#include "ros/messages/gloam_msgs.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"

namespace gloam {
namespace {

constexpr Rational kMetricRate = {10, 1};  // of messages [Hz]

/// Metrics of one subscription, without those of light and visibility, which take a renderer.
InstantEncoder encode_metrics(const TopicWorld& world) {
  Result<std::unique_ptr<Metrics>> made = Metrics::make(*world);
  if (!made.ok()) {
    return [error = made.error()](const TopicInfo&, TopicInstant&, MessageBytes*) {
      return Status(error);
    };
  }
  const std::shared_ptr<Metrics> metrics = *std::move(made);
  return [world, metrics](const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
    const std::vector<double>& row = metrics->sample(at.snapshot());
    gloam_msgs::Metrics message;
    message.header = ros_header(at.snapshot().time(), topic.frame_id);
    for (size_t i = 1; i < row.size(); ++i) {  // 0 is the time
      message.names.push_back(metrics->infos()[i - 1].name);
      message.units.push_back(metrics->infos()[i - 1].unit);
      message.values.push_back(row[i]);
    }
    encode(message, out);
    return Status();
  };
}

}  // namespace

void add_metric_topics(const TopicWorld& world, TopicTable* table) {
  const Result<std::unique_ptr<Metrics>> metrics = Metrics::make(*world);
  if (metrics.ok() && (*metrics)->infos().empty()) return;  // errors: told when it is opened
  const bool is_asked_for = !world->scene.metrics.empty() || !world->scene.goals.empty();
  Topic topic;
  topic.info = {.name = "/metrics",
                .type = type_name<gloam_msgs::Metrics>(),
                .frame_id = kWorldFrameId,
                .rate = kMetricRate,
                .is_logged = is_asked_for,
                .source = {.name = "metrics"}};
  topic.sampled = world->scene.record.metrics_rate;  // as in a recorded run
  topic.code = InstantEncoderMaker([world] { return encode_metrics(world); });
  table->push_back(std::move(topic));
}

}  // namespace gloam
