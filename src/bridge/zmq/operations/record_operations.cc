// Operations that look: pictures, numbers, labels, logs.

#include <fmt/format.h>

#include <cstring>

#include "bridge/zmq/operations/operation.h"
#include "gloam/view.h"

namespace gloam::bridge::zeromq {
namespace {

using enum ArgumentType;
using enum OperationSpeed;

constexpr int kMaxSide = 8192;  // of a picture [px]
constexpr size_t kMaxPixels = 1 << 25;

Status record_start(const Call& call, Packer& out) {
  const LogRequest request{.topics = call.arguments.texts("topics")};
  GLOAM_TRY(const std::string file,
            call.services.operations().start_recording(call.arguments.text("name"), request));
  out.pack_map(1);
  pack_pair(out, "file", file);
  return {};
}

Status record_stop(const Call& call, Packer& out) {
  GLOAM_TRY(const std::string file, call.services.operations().stop_recording());
  out.pack_map(1);
  pack_pair(out, "file", file);
  return {};
}

Result<CameraRequest> picture_request(const Call& call) {
  CameraRequest request{.camera = call.arguments.text("camera", "free")};
  const int64_t width = call.arguments.integer("width");
  const int64_t height = call.arguments.integer("height");
  if (width < 0 || height < 0 || width > kMaxSide || height > kMaxSide ||
      static_cast<size_t>(width * height) > kMaxPixels)
    return Error{ErrorKind::kInput,
                 fmt::format("the width and height of an image must be 1 ... {} px", kMaxSide)};
  request.width = static_cast<int>(width);
  request.height = static_cast<int>(height);
  request.render = call.services.simulation().world().scene().render;
  if (call.arguments.has("outputs")) request.outputs = call.arguments.texts("outputs");
  if (const auto p = call.arguments.numbers("position"); p.size() == 3) {
    request.X_WC = Pose{{p[0], p[1], p[2]}, {}};
    if (const auto q = call.arguments.numbers("orientation"); q.size() == 4)
      request.X_WC->q = {q[0], q[1], q[2], q[3]};
  }
  return request;
}

/// Channels of a frame: arrays of {dtype, shape, data}; their number is counted first.
class PictureWriter {
 public:
  template <class T>
  void add(std::string_view name, const char* dtype, const std::vector<T>& values) {
    if (values.empty()) return;
    const auto* bytes = reinterpret_cast<const uint8_t*>(values.data());
    planes_.push_back({name, dtype, {bytes, values.size() * sizeof(T)}, values.size()});
  }
  uint32_t count() const { return static_cast<uint32_t>(planes_.size()); }
  void pack(Packer& out, const Intrinsics& size) const {
    for (const Plane& plane : planes_) {
      const size_t pixels = static_cast<size_t>(size.width) * static_cast<size_t>(size.height);
      const size_t depth = pixels > 0 ? plane.count / pixels : 0;
      out.pack(plane.name);
      out.pack_map(3);
      pack_pair(out, "dtype", std::string_view(plane.dtype));
      out.pack(std::string_view("shape"));
      out.pack_array(depth > 1 ? 3 : 2);
      out.pack(size.height);
      out.pack(size.width);
      if (depth > 1) out.pack(static_cast<uint64_t>(depth));
      out.pack(std::string_view("data"));
      pack_bytes(out, plane.bytes);
    }
  }

 private:
  struct Plane {
    std::string_view name;
    const char* dtype;
    std::span<const uint8_t> bytes;
    size_t count;
  };
  std::vector<Plane> planes_;
};

PictureWriter channels_of(const CameraFrame& frame) {
  PictureWriter channels;
  channels.add("rgb", "uint8", frame.rgb);
  channels.add("radiance", "float32", frame.radiance);
  channels.add("depth", "float32", frame.depth);
  channels.add("distance", "float32", frame.distance);
  channels.add("part", "uint32", frame.part);
  channels.add("instance", "uint32", frame.instance);
  channels.add("semantic", "uint32", frame.semantic);
  channels.add("normal", "float32", frame.normal);
  channels.add("albedo", "float32", frame.albedo);
  channels.add("samples", "uint32", frame.samples);
  channels.add("motion", "float32", frame.motion);
  channels.add("scene_flow", "float32", frame.scene_flow);
  channels.add("raw", "uint16", frame.raw);
  channels.add("sensor_depth", "float32", frame.sensor_depth);
  channels.add("thermal", "float32", frame.thermal);
  return channels;
}

Status picture(const Call& call, Packer& out) {
  GLOAM_TRY(const CameraRequest request, picture_request(call));
  GLOAM_TRY(const std::shared_ptr<const CameraFrame> frame,
            call.services.operations().picture(request));
  const bool is_jpeg = call.arguments.flag("jpeg");
  std::vector<uint8_t> jpeg;
  if (is_jpeg) {
    GLOAM_TRY(jpeg, encode_jpeg(frame->intrinsics.width, frame->intrinsics.height, frame->rgb));
  }
  const PictureWriter channels = channels_of(*frame);
  out.pack_map(6 + (is_jpeg ? 1 : channels.count()));
  pack_pair(out, "camera", frame->camera);
  pack_pair(out, "step", frame->step);
  pack_pair(out, "time", frame->time);
  pack_pair(out, "width", frame->intrinsics.width);
  pack_pair(out, "height", frame->intrinsics.height);
  const Intrinsics& lens = frame->intrinsics;
  const double numbers[] = {lens.fx, lens.fy, lens.cx, lens.cy};
  out.pack(std::string_view("fx_fy_cx_cy"));
  pack_numbers(out, numbers);
  if (is_jpeg) {
    out.pack(std::string_view("jpeg"));
    pack_bytes(out, jpeg);
  } else {
    channels.pack(out, frame->intrinsics);
  }
  return {};
}

Status value(const Call& call, Packer& out) {
  Instant instant;
  GLOAM_TRY_STATUS(instant.solve(call.services.simulation().latest()));
  GLOAM_TRY(const std::vector<double> values,
            instant.value(call.arguments.text("field"), call.arguments.text("element")));
  out.pack_map(1);
  out.pack(std::string_view("values"));
  pack_numbers(out, values);
  return {};
}

Status labels(const Call& call, Packer& out) {
  GLOAM_TRY(const std::vector<LabelRow> rows, call.services.simulation().labels());
  out.pack_array(static_cast<uint32_t>(rows.size()));
  for (const LabelRow& row : rows) {
    out.pack_map(7);
    pack_pair(out, "part", row.part);
    pack_pair(out, "geom", row.geom);
    pack_pair(out, "body", row.body);
    pack_pair(out, "instance", row.instance);
    pack_pair(out, "instance_name", row.instance_name);
    pack_pair(out, "semantic", row.semantic);
    pack_pair(out, "semantic_name", row.semantic_name);
  }
  return {};
}

}  // namespace

std::vector<Operation> record_operations() {
  return {
      {"record_start",
       "starts an MCAP log of the run: {file}; one at a time",
       kQueued,
       {{"name", kText, false, "", "file name in the recording folder; default: the date"},
        {"topics", kTexts, false, "", "names; * matches any text; default: the usual topics"}},
       record_start},
      {"record_stop", "stops the log: {file}", kQueued, {}, record_stop},
      {"picture",
       "renders one image of the current instant, each channel as {dtype, shape, data}",
       kQueued,
       {{"camera", kText, false, "", "full name; default: 'free', which shows the whole model"},
        {"width", kInteger, false, "px", "default: that of the camera"},
        {"height", kInteger, false, "px", "default: that of the camera"},
        {"outputs", kTexts, false, "", "rgb, depth, segmentation, normal …; default: rgb"},
        {"position", kNumbers, false, "m, (3)", "position of the free camera", 3},
        {"orientation", kNumbers, false, "(4)", "w x y z; the camera looks along -Z, with +Y up",
         4},
        {"jpeg", kBool, false, "", "return rgb as a JPEG file instead of pixels"}},
       picture},
      {"value",
       "reads a MuJoCo array by its name, for all elements or for one: {values}",
       kQueued,
       {{"field", kText, true, "as in MuJoCo", "xpos, geom_friction, opt.gravity …"},
        {"element", kText, false, "", "full name; default: all, row by row"}},
       value},
      {"labels", "ids in segmentation images", kQueued, {}, labels},
  };
}

}  // namespace gloam::bridge::zeromq
