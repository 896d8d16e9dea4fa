// gloam::World::streams: what the model and scene tell, with the rates of LiDARs' presets.

#include <algorithm>

#include "gloam/world.h"
#include "sensors/lidar/lidar_model.h"
#include "world/streams.h"
#include "world/world.h"

namespace gloam {

std::vector<StreamInfo> World::streams() const {
  std::vector<StreamInfo> streams = list_streams(*compiled_);
  for (StreamInfo& stream : streams) {
    if (stream.kind != StreamKind::kLidar) continue;
    const auto lidar = std::ranges::find(compiled_->scene.lidars, stream.name, &LidarOptions::name);
    if (const Result<LidarModel> model = make_lidar_model(*lidar); model.ok())
      stream.rate = model->rate;
  }
  return streams;
}

}  // namespace gloam
