// Topics of weather and gases.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ros/messages/gloam_msgs.h"
#include "sim/effects/wind/wind.h"
#include "topics/model_frames.h"
#include "topics/ros_values.h"
#include "topics/topic_table.h"
#include "world/world.h"

namespace gloam {
namespace {

constexpr Rational kAirRate = {10, 1};  // [Hz]
constexpr double kStandardHeight = 10;  // height of winds in meteorology (WMO-No. 8) [m]

InstantEncoder weather(const TopicWorld& world) {
  return [wind = Wind(world->wind), mean = world->wind.speed,
          options = world->scene.weather.value_or(WeatherOptions{})](
             const TopicInfo& topic, TopicInstant& at, MessageBytes* out) {
    const double time = at.snapshot().time();
    gloam_msgs::Weather message;
    message.header = ros_header(time, topic.frame_id);
    message.visibility = options.visibility.value_or(std::numeric_limits<double>::infinity());
    message.rain = options.rain.value_or(0);
    message.snow = options.snow.value_or(0);
    message.wind = ros_vector(wind.at(time, kStandardHeight));
    message.mean_wind = mean;
    encode(message, out);
    return Status();
  };
}

// Numbers of the field of the gas's last tick, cell by cell in their order.
void read_field(const GasDescription& gas, const FieldWindow& window, gloam_msgs::Gas* to) {
  to->highest_temperature = to->mean_temperature = double{gas.temperature};
  if (window.before == nullptr) return;
  window.before->wait();
  const double cell = std::pow(double{gas.voxel}, 3);
  if (const VolumeGrid& density = window.before->density()) {
    double sum = 0;
    for (const float value : *density) sum += double{value};
    to->medium_mass = sum * cell;
  }
  const VolumeGrid& temperature = window.before->temperature();
  if (temperature == nullptr || temperature->empty()) return;
  double sum = 0;
  for (const float value : *temperature) sum += double{value};
  to->mean_temperature = sum / static_cast<double>(temperature->size());
  to->highest_temperature = double{*std::ranges::max_element(*temperature)};
}

InstantEncoder gas_numbers(size_t row) {
  return [row](const TopicInfo& topic, TopicInstant& at, MessageBytes* out) -> Status {
    const CompiledWorld& world = *at.snapshot().data().world;
    const GasDescription& gas = world.gases.gases[row];
    const double time = at.snapshot().time();
    gloam_msgs::Gas message;
    message.header = ros_header(time, topic.frame_id);
    message.name = gas.name;
    const auto& media = at.snapshot().data().effects.media;
    if (row < media.size()) read_field(gas, media[row], &message);
    for (const GasSourceDescription& fire : world.gases.sources) {
      if (fire.power <= 0) continue;
      GLOAM_TRY(const Pose X_WB, at.X_WB(fire.body));
      const Vec3f& p = fire.X_BS.p;
      if (!gas.holds(product(X_WB, {{p.x, p.y, p.z}, {}}).p)) continue;
      if (fire.is_on(time)) message.heat_release += double{fire.power_at(time)};
      message.heat_released += fire.heat_until(time);
    }
    const double per_joule =
        gas.fuel.heat_of_combustion > 0 ? 1 / double{gas.fuel.heat_of_combustion} : 0;
    message.fuel_rate = message.heat_release * per_joule;
    message.fuel_burned = message.heat_released * per_joule;
    encode(message, out);
    return {};
  };
}

}  // namespace

void add_air_topics(const TopicWorld& world, TopicTable* table) {
  const auto add = [table](std::string name, std::string type, TopicSource source,
                           InstantEncoder encode) {
    table->push_back({{.name = std::move(name),
                       .type = std::move(type),
                       .frame_id = kWorldFrameId,
                       .rate = kAirRate,
                       .source = std::move(source)},
                      {},
                      {},
                      std::move(encode)});
  };
  if (world->scene.weather)
    add("/weather", type_name<gloam_msgs::Weather>(), {.name = "weather"}, weather(world));
  for (size_t row = 0; row < world->gases.gases.size(); ++row) {
    std::string name = world->gases.gases[row].name;
    if (name.empty()) name = fmt::format("gas_{}", row);
    add("/" + topic_token(name) + "/gas", type_name<gloam_msgs::Gas>(),
        {TopicSource::Kind::kGas, name}, gas_numbers(row));
  }
}

}  // namespace gloam
