// Topics of sensors. A gyro and an accelerometer at one site are an IMU, force and torque a wrench;
// every other sensor and each probe has a topic of its own.

#include <cmath>
#include <map>

#include "ros/messages/gloam_msgs.h"
#include "ros/messages/sensor_msgs.h"
#include "scene/options/probe_quantities.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/sensors/sensor_description.h"
#include "world/streams.h"
#include "world/world.h"

namespace gloam {
namespace {

using Samples = std::span<const SensorMessage>;

geometry_msgs::Vector3 vector_of(const SensorMessage& sample) {
  return {sample.values[0], sample.values[1], sample.values[2]};
}
geometry_msgs::Quaternion quaternion_of(const SensorMessage& sample) {
  return {sample.values[1], sample.values[2], sample.values[3], sample.values[0]};
}

// REP 145: +g upwards at rest; the first covariance of what is not measured is -1.
Status encode_imu(const TopicInfo& topic, Samples samples, MessageBytes* out) {
  sensor_msgs::Imu imu;
  imu.header = ros_header(samples[0].time, topic.frame_id);
  imu.angular_velocity = vector_of(samples[0]);
  imu.linear_acceleration = vector_of(samples[1]);
  if (samples.size() > 2)
    imu.orientation = quaternion_of(samples[2]);
  else
    imu.orientation_covariance[0] = -1;
  encode(imu, out);
  return {};
}

Status encode_wrench(const TopicInfo& topic, Samples samples, MessageBytes* out) {
  encode(geometry_msgs::WrenchStamped{ros_header(samples[0].time, topic.frame_id),
                                      {vector_of(samples[0]), vector_of(samples[1])}},
         out);
  return {};
}

SampleEncoder range(double cutoff) {
  return [cutoff](const TopicInfo& topic, Samples samples, MessageBytes* out) {
    sensor_msgs::Range message;
    message.header = ros_header(samples[0].time, topic.frame_id);
    message.radiation_type = sensor_msgs::Range::INFRARED;
    const double distance = samples[0].values[0];
    message.max_range = cutoff > 0 ? static_cast<float>(cutoff) : INFINITY;
    message.range = distance < 0 ? INFINITY : static_cast<float>(distance);  // REP 117
    encode(message, out);
    return Status();
  };
}

Status encode_magnetic(const TopicInfo& topic, Samples samples, MessageBytes* out) {
  sensor_msgs::MagneticField message;
  message.header = ros_header(samples[0].time, topic.frame_id);
  message.magnetic_field = vector_of(samples[0]);
  encode(message, out);
  return {};
}

Status encode_numbers(const TopicInfo&, Samples samples, MessageBytes* out) {
  std_msgs::Float64MultiArray message;
  const auto count = static_cast<uint32_t>(samples[0].values.size());
  message.layout.dim = {{samples[0].sensor, count, count}};
  message.data = samples[0].values;
  encode(message, out);
  return {};
}

Status encode_vector(const TopicInfo& topic, Samples samples, MessageBytes* out) {
  encode(geometry_msgs::Vector3Stamped{ros_header(samples[0].time, topic.frame_id),
                                       vector_of(samples[0])},
         out);
  return {};
}

Status encode_illuminance(const TopicInfo& topic, Samples samples, MessageBytes* out) {
  sensor_msgs::Illuminance message;
  message.header = ros_header(samples[0].time, topic.frame_id);
  message.illuminance = samples[0].values[0];
  encode(message, out);
  return {};
}

Status encode_temperature(const TopicInfo& topic, Samples samples, MessageBytes* out) {
  constexpr double kFreezing = 273.15;  // ROS has degrees Celsius [K]
  sensor_msgs::Temperature message;
  message.header = ros_header(samples[0].time, topic.frame_id);
  message.temperature = samples[0].values[0] - kFreezing;
  encode(message, out);
  return {};
}

SampleEncoder probe_numbers(const ProbeQuantity& quantity) {
  return [&quantity](const TopicInfo& topic, Samples samples, MessageBytes* out) {
    gloam_msgs::Probe message;
    message.header = ros_header(samples[0].time, topic.frame_id);
    message.quantity = quantity.word;
    for (const ProbeNumber& number : std::span(quantity.numbers).first(samples[0].values.size())) {
      message.names.emplace_back(number.name);
      message.units.emplace_back(number.unit);
    }
    message.values = samples[0].values;
    encode(message, out);
    return Status();
  };
}

class SensorTopics {
 public:
  SensorTopics(const TopicWorld& world, TopicTable* table)
      : world_(*world), m_(*world->model), table_(table), sensors_(describe_sensors(*world)) {
    for (const StreamInfo& stream : list_streams(*world))
      if (stream.kind == StreamKind::kSensor) streams_.push_back(stream);
    taken_.resize(sensors_.size());
  }

  void add() {
    for (int site = 0; site < static_cast<int>(m_.nsite); ++site) add_groups(site);
    for (size_t i = 0; i < sensors_.size(); ++i)
      if (sensors_[i].probe >= 0)
        add_probe(static_cast<int>(i));
      else if (!taken_[i])
        add_one(static_cast<int>(i));
  }

 private:
  int find(int site, int type) const {
    for (int i = 0; i < static_cast<int>(m_.nsensor); ++i)
      if (m_.sensor_type[i] == type && m_.sensor_objtype[i] == mjOBJ_SITE &&
          m_.sensor_objid[i] == site)
        return i;
    return -1;
  }

  // A pair of sensors that have no site's name in common would need a name: theirs is the first's.
  void add_groups(int site) {
    const int gyro = find(site, mjSENS_GYRO), acceleration = find(site, mjSENS_ACCELEROMETER);
    const int orientation = find(site, mjSENS_FRAMEQUAT);
    if (gyro >= 0 && acceleration >= 0) {
      std::vector<int> parts = {gyro, acceleration};
      if (orientation >= 0) parts.push_back(orientation);
      add_topic(parts, "/imu", type_name<sensor_msgs::Imu>(), encode_imu);
    }
    const int force = find(site, mjSENS_FORCE), torque = find(site, mjSENS_TORQUE);
    if (force >= 0 && torque >= 0)
      add_topic({force, torque}, "/wrench", type_name<geometry_msgs::WrenchStamped>(),
                encode_wrench);
  }

  void add_one(int sensor) {
    switch (m_.sensor_type[sensor]) {
      case mjSENS_RANGEFINDER:
        if (sensors_[static_cast<size_t>(sensor)].count != 1) break;
        return add_topic({sensor}, "", type_name<sensor_msgs::Range>(),
                         range(m_.sensor_cutoff[sensor]));
      case mjSENS_MAGNETOMETER:
        return add_topic({sensor}, "", type_name<sensor_msgs::MagneticField>(), encode_magnetic);
      default:
        break;
    }
    add_topic({sensor}, "", type_name<std_msgs::Float64MultiArray>(), encode_numbers);
  }

  void add_probe(int row) {
    const auto probe = static_cast<size_t>(sensors_[static_cast<size_t>(row)].probe);
    const ProbeQuantity& quantity = *world_.probes[probe].quantity;
    if (quantity.is_vector())
      return add_topic({row}, "", type_name<geometry_msgs::Vector3Stamped>(), encode_vector);
    if (quantity.word == "illuminance")
      return add_topic({row}, "", type_name<sensor_msgs::Illuminance>(), encode_illuminance);
    if (quantity.word == "gas_temperature")
      return add_topic({row}, "", type_name<sensor_msgs::Temperature>(), encode_temperature);
    add_topic({row}, "", type_name<gloam_msgs::Probe>(), probe_numbers(quantity));
  }

  void add_topic(const std::vector<int>& parts, const char* suffix, std::string type,
                 SampleEncoder encode) {
    const StreamInfo& first = streams_[static_cast<size_t>(parts[0])];
    const bool is_group = parts.size() > 1;
    const std::string name = is_group ? first.frame_id : first.name;
    Topic topic;
    topic.info = {.name = "/" + topic_token(name) + suffix,
                  .type = std::move(type),
                  .frame_id = first.frame_id,
                  .rate = first.rate.num != 0 ? first.rate : kSampleRate,
                  .qos = kSensorQos,
                  .source = {TopicSource::Kind::kSensor, first.name}};
    for (const int part : parts) {
      topic.streams.push_back(streams_[static_cast<size_t>(part)].name);
      taken_[static_cast<size_t>(part)] = true;
    }
    topic.code = std::move(encode);
    table_->push_back(std::move(topic));
  }

  const CompiledWorld& world_;
  const mjModel& m_;
  TopicTable* table_;
  std::vector<SensorDescription> sensors_;
  std::vector<StreamInfo> streams_;
  std::vector<bool> taken_;
};

}  // namespace

void add_sensor_topics(const TopicWorld& world, TopicTable* table) {
  SensorTopics(world, table).add();
}

}  // namespace gloam
