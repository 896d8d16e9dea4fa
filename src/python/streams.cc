// Opening of streams, and render requests.

#include "streams.h"

#include "frames.h"
#include "inbox.h"
#include "messages.h"
#include "run.h"

namespace gloam::python {
namespace {

// Where several threads may add messages and one Python object looks: see Inbox.
std::shared_ptr<Inbox> make_inbox(Run& run, std::string name, nb::object callback) {
  constexpr int kQueueCapacity = 64;  // messages
  run.simulation();
  const auto destroy = [](Inbox* inbox) {
    destroy_when_safe(Kept::kStream, [inbox] {
      try {
        if (inbox->try_close()) delete inbox;
      } catch (nb::python_error& error) {
        error.discard_as_unraisable("closing a stream");
      }
    });
  };
  return {new Inbox(std::move(name), kQueueCapacity, std::move(callback)), destroy};
}

template <class S>
std::shared_ptr<Inbox> open(Run& run, std::shared_ptr<Inbox> inbox,
                            Result<std::unique_ptr<S>> stream) {
  inbox->open(take(std::move(stream)), run.latest().step());
  run.add(inbox);
  return inbox;
}

std::shared_ptr<Inbox> open_camera(Run& run, const nb::dict& options, nb::object callback) {
  const CameraRequest request = camera_request(options, run.scene_render());
  auto inbox = make_inbox(run, "camera '" + request.camera + "'", std::move(callback));
  const auto take_frame = [raw = inbox.get()](std::shared_ptr<const CameraFrame> frame) {
    const int64_t next = frame->step + 1;
    const double delivery = frame->delivery;
    raw->put({next, delivery, [frame = std::move(frame)] { return nb::cast(Frame{frame}); }});
  };
  auto stream = without_gil([&] { return run.simulation().open_camera(request, take_frame); });
  return open(run, std::move(inbox), std::move(stream));
}

std::shared_ptr<Inbox> open_lidar(Run& run, const std::string& name, bool required,
                                  nb::object callback) {
  auto inbox = make_inbox(run, "lidar '" + name + "'", std::move(callback));
  const auto take_scan = [raw = inbox.get()](std::shared_ptr<const LidarScan> scan) {
    const int64_t next = scan->step;
    raw->put({next, scan->end, [scan = std::move(scan)] { return nb::cast(Scan{scan}); }});
  };
  LidarRequest request;
  request.lidar = name;
  request.required = required;
  auto stream = without_gil([&] { return run.simulation().open_lidar(request, take_scan); });
  return open(run, std::move(inbox), std::move(stream));
}

std::shared_ptr<Inbox> open_sensor(Run& run, const std::string& name, bool required,
                                   nb::object callback) {
  auto inbox = make_inbox(run, "sensor '" + name + "'", std::move(callback));
  const auto take_sample = [raw = inbox.get()](const SensorMessage& sample) {
    raw->put({sample.step + 1, sample.delivery, [sample] { return nb::cast(sample); }});
  };
  SensorRequest request;
  request.sensor = name;
  request.required = required;
  auto stream = without_gil([&] { return run.simulation().open_sensor(request, take_sample); });
  return open(run, std::move(inbox), std::move(stream));
}

std::shared_ptr<Inbox> open_topics(Run& run, const std::vector<std::string>& topics, bool required,
                                   nb::object callback, bool every_sample) {
  auto inbox = make_inbox(run, "topic '" + (topics.empty() ? std::string() : topics[0]) + "'",
                          std::move(callback));
  const auto take_message = [raw = inbox.get()](const TopicMessage& message) {
    auto kept = std::make_shared<Message>(Message{message.topic.name,
                                                  message.topic.type,
                                                  message.step,
                                                  message.time,
                                                  message.delivery,
                                                  {message.data.begin(), message.data.end()}});
    raw->put({message.step, message.delivery, [kept] { return nb::cast(kept); }});
  };
  TopicRequest request;
  request.topics = topics;
  request.required = required;
  request.every_sample = every_sample;
  auto stream = without_gil([&] { return run.simulation().open_topics(request, take_message); });
  return open(run, std::move(inbox), std::move(stream));
}

CameraStream& camera_stream(Inbox& inbox) {
  auto* camera = dynamic_cast<CameraStream*>(&inbox.stream());
  if (camera == nullptr) raise("UsageError", "this is not a camera stream");
  return *camera;
}

/// Reads the name of an enum's value. Leaves `value` as it is if the name is not given, None or "".
/// Raises a UsageError for other names.
template <NamedEnum Enum, class Value>
void read_named(Keywords& keywords, const char* key, Value* value) {
  std::string name;
  keywords.read(key, &name);
  if (!name.empty()) *value = take(enum_named<Enum>(name));
}

}  // namespace

RenderOptions render_options(Keywords& keywords, const RenderOptions& scene) {
  RenderOptions render = scene;
  std::optional<int> spp;
  std::optional<double> error;
  read_named<RenderTier>(keywords, "tier", &render.tier);
  keywords.read("spp", &spp);
  keywords.read("error", &error);
  if (error || spp) render.spp = spp;
  if (error || spp || render.tier_or_default(false) != RenderTier::kPath) render.error = error;
  keywords.read("max_depth", &render.max_depth);
  read_named<RenderDevice>(keywords, "device", &render.device);
  keywords.read("denoise", &render.denoise);
  read_named<RenderLook>(keywords, "look", &render.look);
  keywords.read("ev100", &render.ev100);
  return render;
}

Rational rational(double rate) {
  for (int64_t den = 1; den <= 1000000; den *= 10) {
    const double num = rate * static_cast<double>(den);
    if (num == static_cast<double>(static_cast<int64_t>(num)))
      return {static_cast<int64_t>(num), den};
  }
  return {static_cast<int64_t>(rate * 1e6 + 0.5), 1000000};
}

CameraRequest camera_request(const nb::dict& options, const RenderOptions& scene) {
  Keywords keywords(options);
  CameraRequest request;
  request.render = render_options(keywords, scene);
  keywords.read("camera", &request.camera);
  keywords.read("outputs", &request.outputs);
  keywords.read("width", &request.width);
  keywords.read("height", &request.height);
  keywords.read("required", &request.required);
  double rate = 0;
  keywords.read("rate", &rate);
  nb::object X_WC = nb::none();
  keywords.read("pose", &X_WC);
  keywords.refuse_others();
  if (!(rate >= 0 && rate < 1e6)) raise("UsageError", "rate must be at least 0 and below 1e6 Hz");
  request.rate = rational(rate);
  if (!X_WC.is_none()) request.X_WC = pose(X_WC);
  return request;
}

void bind_streams(nb::module_& m) {
  bind_messages(m);
  nb::class_<Inbox>(m, "Stream", "An open stream of messages.", nb::type_slots(kept_slots<Inbox>()))
      .def("close", &Inbox::close)
      .def_prop_ro("is_open", &Inbox::is_open)
      .def_prop_ro("restarts", &Inbox::restarts)
      .def_prop_ro("dropped", [](Inbox& inbox) { return inbox.stream().dropped() + inbox.lost(); })
      .def("flush", &Inbox::flush)
      .def("pop",
           [](Inbox& inbox) {
             inbox.rethrow();
             check(inbox.stream().status());
             const std::optional<Waiting> message = inbox.pop();
             return message ? message->make() : nb::object(nb::none());
           })
      .def(
          "wait",
          [](Inbox& inbox, std::optional<double> timeout) {
            const std::optional<Waiting> message = inbox.wait(timeout);
            return message ? message->make() : nb::object(nb::none());
          },
          nb::arg("timeout").none() = nb::none(),
          "The next message of a running simulation; None: not within `timeout` [s of wall time].")
      .def("set_pose",
           [](Inbox& inbox, nb::handle X_WC) { camera_stream(inbox).set_pose(pose(X_WC)); });
  m.def("open_camera", &open_camera, nb::arg("run"), nb::arg("options"),
        nb::arg("callback").none() = nb::none());
  m.def("open_lidar", &open_lidar, nb::arg("run"), nb::arg("name"), nb::arg("required") = true,
        nb::arg("callback").none() = nb::none());
  m.def("open_sensor", &open_sensor, nb::arg("run"), nb::arg("name"), nb::arg("required") = true,
        nb::arg("callback").none() = nb::none());
  m.def("open_topics", &open_topics, nb::arg("run"), nb::arg("topics"), nb::arg("required") = true,
        nb::arg("callback").none() = nb::none(), nb::arg("every_sample") = false);
}

}  // namespace gloam::python
