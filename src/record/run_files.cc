#include "record/run_files.h"

#include <nlohmann/json.hpp>
#include <string_view>

#include "geometry/lens.h"

namespace gloam {
namespace {
using Json = nlohmann::ordered_json;

// Names come from users' files: bytes that are not UTF-8 are replaced, never passed on.
std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

template <class Pairs>
Json object(const Pairs& pairs) {
  Json out = Json::object();
  for (const auto& [name, value] : pairs) out[name] = value;
  return out;
}

/// A recording error without what the state says already.
std::string cause_of(std::string_view error) {
  constexpr std::string_view kStopped = "recording stopped: ";
  if (error.starts_with(kStopped)) error.remove_prefix(kStopped.size());
  return std::string(error);
}

void add_episodes(const RunOutcome& outcome, Json* metrics) {
  if (!outcome.missing_metrics.empty())
    (*metrics)["missing_values"] = object(outcome.missing_metrics);
  Json& list = (*metrics)["episodes"] = Json::array();
  for (const RunOutcome::Episode& episode : outcome.episodes)
    list.push_back({{"steps", episode.steps},
                    {"simulated_s", episode.simulated},
                    {"final_state_hash", episode.state_hash},
                    {"results", object(episode.results)}});
}

}  // namespace

std::string summary_json(const RunInfo& info, const RunOutcome* outcome,
                         const std::vector<CameraCounts>& cameras,
                         const std::vector<CameraCounts>& lidars,
                         const std::vector<std::string>& sensor_files, int64_t metric_rows,
                         uint64_t dropped_metric_rows, const std::vector<std::string>& entries,
                         const std::string& error) {
  Json out;
  out["format"] = "gloam-run 1";
  out["title"] = info.title;
  const std::string cause = cause_of(error);
  out["state"] = outcome == nullptr ? "recording"
                 : cause.empty()    ? "finished"
                                    : "stopped: " + cause;
  const bool is_cut = outcome != nullptr && outcome->exit_reason == "completed" && !cause.empty();
  out["exit_reason"] = outcome == nullptr ? Json() : Json(is_cut ? cause : outcome->exit_reason);
  out["recording_error"] = error.empty() ? Json() : Json(error);
  out["versions"] = object(info.versions);
  out["scene"] = {{"file", info.scene_file}, {"hash", info.scene_hash}};
  out["seed"] = info.seed;
  out["timestep_s"] = info.timestep;
  out["planned_s"] = info.duration;
  out["settings"] = object(info.settings);
  if (!info.drawn.empty()) out["drawn"] = object(info.drawn);
  if (outcome != nullptr) {
    out["simulated_s"] = outcome->simulated;
    out["steps"] = outcome->steps;
    out["final_state_hash"] = outcome->final_state_hash;
    out["results"] = object(outcome->results);
    out["timings_s"] = object(outcome->timings);
  }
  Json list = Json::array();
  for (const CameraCounts& camera : cameras)
    list.push_back({{"name", camera.name},
                    {"folder", camera.file_name},
                    {"frames", camera.frames},
                    {"dropped_frames", camera.dropped}});
  out["cameras"] = list;
  if (!lidars.empty()) {
    list = Json::array();
    for (size_t i = 0; i < lidars.size(); ++i)
      list.push_back({{"name", lidars[i].name},
                      {"folder", lidars[i].file_name},
                      {"rate_hz", info.lidars[i].rate.value()},
                      {"scans", lidars[i].frames},
                      {"dropped_scans", lidars[i].dropped}});
    out["lidars"] = list;
  }
  if (!info.sensors.empty()) {
    list = Json::array();
    for (size_t i = 0; i < info.sensors.size(); ++i)
      list.push_back({{"name", info.sensors[i].name}, {"file", "sensors/" + sensor_files[i]}});
    out["sensors"] = list;
  }
  out["metrics"] = {{"rows", metric_rows}, {"dropped_rows", dropped_metric_rows}};
  if (outcome != nullptr) add_episodes(*outcome, &out["metrics"]);
  out["entries"] = entries;
  return dump(out);
}

std::string cameras_json(const std::vector<RecordedCamera>& cameras,
                         const std::vector<std::string>& file_names) {
  Json list = Json::array();
  for (size_t i = 0; i < cameras.size(); ++i) {
    const RecordedCamera& camera = cameras[i];
    const Intrinsics& k = camera.intrinsics;
    Json one;
    one["name"] = camera.name;
    one["folder"] = file_names[i];
    one["frame_id"] = camera.name + "_optical_frame";
    one["rate_hz"] = {{"num", camera.rate.num}, {"den", camera.rate.den}};
    one["width_px"] = k.width;
    one["height_px"] = k.height;
    const CameraInfo info = camera_info(camera.name, k);
    one["projection"] = k.orthographic || is_wide(k.lens) ? info.distortion_model : "pinhole";
    one["fx_px"] = k.fx;
    one["fy_px"] = k.fy;
    one["cx_px"] = k.cx;
    one["cy_px"] = k.cy;
    // ROS and OpenCV count pixel centres at integers, Gloam at integer + 0.5.
    if (!k.orthographic)
      one["camera_info"] = {
          {"distortion_model", info.distortion_model}, {"d", info.d}, {"k", info.k}};
    list.push_back(one);
  }
  Json out;
  out["conventions"] = {
      {"pixels",
       "fx, fy, cx, cy from the top left corner of the image, pixel centres at integer + 0.5; "
       "camera_info.k as in ROS and OpenCV, pixel centres at integers"},
      {"poses",
       "poses.csv: pose of frame_id in the world; Z forward, X right, Y down; metres; quaternion w "
       "first"},
      {"depth",
       "along Z of frame_id, for equidistant and equirectangular cameras along the ray; "
       "depth/*.png 16-bit millimetres, 0 = nothing or beyond 65.535 m; depth_exr/*.exr channel Z, "
       "float metres, inf = nothing"},
      {"motion",
       "motion/*.exr pixels since the previous frame; scene_flow/*.exr metres, world axes"}};
  out["cameras"] = list;
  return dump(out);
}

std::string objects_json(const std::vector<ObjectView>& objects) {
  const auto box = [](const PixelBox& b) {
    return b.pixels > 0 ? Json{b.u0, b.v0, b.u1, b.v1} : Json();
  };
  Json list = Json::array();
  for (const ObjectView& object : objects) {
    Json one;
    one["instance"] = object.instance;
    one["name"] = object.name;
    one["semantic"] = object.semantic;
    one["visibility"] = object.visibility();
    one["pixels"] = object.seen.pixels;
    one["box_px"] = box(object.seen);
    one["whole_box_px"] = box(object.all);
    const Pose& X = object.X_WO;
    one["position_m"] = {X.p.x, X.p.y, X.p.z};
    one["quaternion_wxyz"] = {X.q.w, X.q.x, X.q.y, X.q.z};
    if (!object.endless) {
      one["box_center_m"] = {object.center.x, object.center.y, object.center.z};
      one["box_size_m"] = {object.size.x, object.size.y, object.size.z};
    }
    list.push_back(one);
  }
  return dump({{"objects", list}});
}

std::string labels_json(const std::vector<LabelRow>& labels, const std::vector<LabelIds>& ids) {
  std::map<uint32_t, std::string> categories;
  std::map<uint32_t, std::pair<std::string, uint32_t>> instances;
  Json parts = Json::array();
  const auto id_or_null = [](int id) { return id >= 0 ? Json(id) : Json(); };
  for (size_t i = 0; i < labels.size(); ++i) {
    const LabelRow& row = labels[i];
    const LabelIds own = i < ids.size() ? ids[i] : LabelIds();
    if (row.semantic != 0) categories.try_emplace(row.semantic, row.semantic_name);
    if (row.instance != 0)
      instances.try_emplace(row.instance, std::pair(row.instance_name, row.semantic));
    parts.push_back({{"id", row.part},
                     {"geom", row.geom},
                     {"geom_id", id_or_null(own.geom)},  // MuJoCo's
                     {"body", row.body},
                     {"body_id", id_or_null(own.body)},
                     {"material", row.material},
                     {"instance_id", row.instance},
                     {"category_id", row.semantic}});
  }
  Json out;
  out["nothing"] = 0;
  out["categories"] = Json::array();  // ids of semantic/*.png
  for (const auto& [id, name] : categories)
    out["categories"].push_back({{"id", id}, {"name", name}});
  out["instances"] = Json::array();  // ids of instance/*.png
  for (const auto& [id, what] : instances)
    out["instances"].push_back({{"id", id}, {"name", what.first}, {"category_id", what.second}});
  out["parts"] = parts;
  return dump(out);
}

}  // namespace gloam
