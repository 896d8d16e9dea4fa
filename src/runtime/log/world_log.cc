#include "runtime/log/world_log.h"

#include "base/files.h"
#include "ros/codec.h"
#include "ros/messages/std_msgs.h"
#include "runtime/log/files/scene_folder.h"

namespace gloam {

Status WorldLog::write(const CompiledWorld& world, const WorldStart& start, uint64_t log_time) {
  DescribedRun run = describe_run(world, simulation_.seed(), simulation_.simulator().own_timestep(),
                                  request_.file);
  run.text.run = start.run;
  run.text.step = start.step;
  run.text.has_history = start.has_history;
  remember_scene_folder(run);
  std::vector<uint8_t> bytes;
  encode(std_msgs::String{to_json(run.text)}, &bytes);
  channels_.write(kWorldTopic, log_time, bytes);
  return request_.embed ? embed(run) : Status();
}

// Files that an earlier World has already embedded are not written again.
Status WorldLog::embed(const DescribedRun& run) {
  for (size_t i = 0; i < run.files.size(); ++i) {
    McapAttachment attachment;
    attachment.name = run.text.files[i].path;
    if (!embedded_.insert(attachment.name).second) continue;
    GLOAM_TRY(attachment.data, read_file(run.files[i]));
    attachment.media_type = "application/octet-stream";
    GLOAM_TRY_STATUS(channels_.queue().push(std::move(attachment)));
  }
  return {};
}

}  // namespace gloam
