#include "fake_simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "studio/free_camera.h"

namespace gloam {
namespace {

using namespace studio;
using std::chrono::milliseconds;

constexpr double kTimestep = 0.002;

struct Hit {
  double distance = 1e9;
  Vec3 point, normal, color;
  int body = -1;  // 0 = floor
};

Vec3 unit(const Vec3& v) { return (1 / norm(v)) * v; }

Pose looking(const Vec3& from, const Vec3& to) {
  // The orbit camera builds upright poses; here it is only borrowed for that.
  const Vec3 direction = unit(to - from);
  OrbitCamera camera({{0, 0, 0}, {std::sqrt(0.5), std::sqrt(0.5), 0, 0}}, 1);  // looks along +Y
  const double azimuth = std::atan2(direction.y, direction.x);
  camera.orbit((std::acos(-1.0) / 2 - azimuth) / std::acos(-1.0),
               -std::asin(direction.z) / std::acos(-1.0));
  Pose pose = camera.pose();
  pose.p = from;
  return pose;
}

}  // namespace

class FakeSimulation::Stream : public CameraStream {
 public:
  Stream(FakeSimulation& simulation, CameraRequest request, FrameCallback on_frame)
      : simulation_(simulation), request_(std::move(request)), on_frame_(std::move(on_frame)) {
    pose_ = request_.camera == "front"        ? looking({0, -4, 1}, {0, 0, 0.4})
            : request_.camera == "robot/head" ? looking({2, 2, 2}, {0, 0, 0.3})
            : request_.X_WC                   ? *request_.X_WC
                                              : looking({2.6, -2.8, 1.9}, {0, 0, 0.35});
    ++simulation_.open_streams_;
    thread_ = std::thread([this] { run(); });
  }
  ~Stream() override {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_one();
    thread_.join();
    --simulation_.open_streams_;
  }
  void set_pose(const Pose& X_WC) override {
    const std::lock_guard lock(mutex_);
    if (request_.camera == "free") pose_ = X_WC;
  }
  Pose pose() const override {
    const std::lock_guard lock(mutex_);
    return pose_;
  }
  void show(const Snapshot&) override { refresh(); }
  void refresh() override {
    {
      const std::lock_guard lock(mutex_);
      refresh_ = true;
    }
    wake_.notify_one();
  }
  int64_t dropped() const override { return 0; }
  int64_t complete_at(int64_t from) const override { return from; }
  void flush() override {}
  Status status() const override { return {}; }

 private:
  void run() {
    int64_t last = -1;
    std::unique_lock lock(mutex_);
    while (!stopping_) {
      const double time = simulation_.stats().time;
      const auto due = static_cast<int64_t>(time * request_.rate.value());
      if (due != last || refresh_) {
        refresh_ = false;
        last = due;
        auto frame = std::make_shared<CameraFrame>();
        frame->camera = request_.camera;
        frame->index = due;
        frame->time = time;
        frame->X_WC = pose_;
        const int width = request_.width ? request_.width : 640;
        const int height = request_.height ? request_.height : 480;
        frame->intrinsics = {width, height, 1.2 * height, 1.2 * height, width / 2.0, height / 2.0};
        lock.unlock();
        simulation_.draw(*frame);
        on_frame_(frame);
        lock.lock();
      }
      wake_.wait_for(lock, milliseconds(5), [this] { return stopping_ || refresh_; });
    }
  }

  FakeSimulation& simulation_;
  const CameraRequest request_;
  const FrameCallback on_frame_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Pose pose_;
  bool stopping_ = false, refresh_ = false;
  std::thread thread_;
};

FakeSimulation::FakeSimulation() : thread_([this] { run(); }) {}

FakeSimulation::~FakeSimulation() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void FakeSimulation::run() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    wake_.wait_for(lock, milliseconds(4));
    if (running_) steps_ += speed_ * 2;
    if (!drags_.empty() && drags_.back().active) {
      const Vec3 target = drags_.back().target_W;
      lock.unlock();
      const Vec3 center = balls()[0].center;
      lock.lock();
      if (running_) pulled_ = pulled_ + 0.05 * (target - center);
    } else {
      pulled_ = 0.97 * pulled_;
    }
  }
}

void FakeSimulation::note(std::string call) {
  const std::lock_guard lock(mutex_);
  calls_.push_back(std::move(call));
}

Status FakeSimulation::run_until(int64_t) { return {}; }

void FakeSimulation::resume() {
  note("resume");
  const std::lock_guard lock(mutex_);
  running_ = true;
}

void FakeSimulation::pause() {
  note("pause");
  const std::lock_guard lock(mutex_);
  running_ = false;
}

bool FakeSimulation::paused() const {
  const std::lock_guard lock(mutex_);
  return !running_;
}

Status FakeSimulation::step(int64_t n) {
  std::this_thread::sleep_for(milliseconds(step_milliseconds.load()));
  note("step");
  const std::lock_guard lock(mutex_);
  running_ = false;
  if (status_.ok()) steps_ = std::floor(steps_) + static_cast<double>(n);
  return status_;
}

void FakeSimulation::set_pace(Pace, double speed) {
  char text[32];
  std::snprintf(text, sizeof text, "speed %g", speed);
  note(text);
  const std::lock_guard lock(mutex_);
  speed_ = speed;
}

Status FakeSimulation::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void FakeSimulation::fail(Error error) {
  const std::lock_guard lock(mutex_);
  status_ = std::move(error);
  running_ = false;
}

Status FakeSimulation::post(const Command& command) {
  const std::lock_guard lock(mutex_);
  if (const auto* drag = std::get_if<DragBody>(&command.what)) drags_.push_back(*drag);
  if (std::holds_alternative<ResetSim>(command.what)) {
    calls_.push_back("reset");
    steps_ = 0;
    status_ = {};
    pulled_ = {};
  }
  return {};
}

SimulationStats FakeSimulation::stats() const {
  const std::lock_guard lock(mutex_);
  const auto step = static_cast<int64_t>(steps_);
  return {.step = step,
          .time = static_cast<double>(step) * kTimestep,
          .hash = 0x9e3779b97f4a7c15ull * static_cast<uint64_t>(step + 1),
          .realtime_factor = running_ ? speed_ * 0.998 : 0};
}

Result<std::unique_ptr<CameraStream>> FakeSimulation::open_camera(const CameraRequest& request,
                                                                  FrameCallback on_frame) {
  note("open " + request.camera);
  const auto names = camera_names();
  if (request.camera != "free" &&
      std::find(names.begin(), names.end(), request.camera) == names.end())
    return Error{.message = "there is no camera '" + request.camera + "'"};
  return std::unique_ptr<CameraStream>(
      std::make_unique<Stream>(*this, request, std::move(on_frame)));
}

std::vector<std::string> FakeSimulation::calls() const {
  const std::lock_guard lock(mutex_);
  return calls_;
}

std::vector<DragBody> FakeSimulation::drags() const {
  const std::lock_guard lock(mutex_);
  return drags_;
}

std::vector<FakeSimulation::Ball> FakeSimulation::balls() const {
  const double t = stats().time;
  std::vector<Ball> list = {
      {{std::cos(t), std::sin(t), 0.35}, 0.35, {0.85, 0.35, 0.2}, "robot/trunk"},
      {{0, 0, 0.5}, 0.5, {0.25, 0.5, 0.7}, "globe"},
      {{-1.2, 0.9, 0.25}, 0.25, {0.8, 0.75, 0.6}, ""}};
  const std::lock_guard lock(mutex_);
  list[0].center = list[0].center + pulled_;
  return list;
}

namespace {

/// Nearest of the floor and the balls along a ray.
template <class Balls>
Hit cast(const Balls& balls, const Vec3& from, const Vec3& along) {
  Hit hit;
  if (along.z < -1e-9) {
    hit.distance = -from.z / along.z;
    hit.point = from + hit.distance * along;
    hit.normal = {0, 0, 1};
    const bool odd =
        (static_cast<int>(std::floor(hit.point.x)) + static_cast<int>(std::floor(hit.point.y))) & 1;
    hit.color = odd ? Vec3{0.62, 0.6, 0.57} : Vec3{0.45, 0.44, 0.43};
    hit.body = 0;
  }
  for (size_t i = 0; i < balls.size(); ++i) {
    const Vec3 offset = from - balls[i].center;
    const double b = dot(offset, along);
    const double discriminant = b * b - dot(offset, offset) + balls[i].radius * balls[i].radius;
    const double distance = -b - std::sqrt(std::max(discriminant, 0.0));
    if (discriminant <= 0 || distance < 1e-4 || distance >= hit.distance) continue;
    hit.distance = distance;
    hit.point = from + distance * along;
    hit.normal = unit(hit.point - balls[i].center);
    hit.color = balls[i].color;
    hit.body = static_cast<int>(i) + 1;
  }
  return hit;
}

}  // namespace

void FakeSimulation::draw(CameraFrame& frame) const {
  const auto list = balls();
  const Intrinsics& k = frame.intrinsics;
  const Vec3 sun = unit({0.5, -0.4, 0.9});
  frame.rgb.resize(size_t{3} * static_cast<size_t>(k.width * k.height));
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Vec3 along = unit(*point_at(frame.X_WC, k, u + 0.5, v + 0.5, 1) - frame.X_WC.p);
      const Hit hit = cast(list, frame.X_WC.p, along);
      Vec3 color = {0.66, 0.74, 0.84};
      if (hit.body >= 0) {
        const bool shadow = cast(list, hit.point + 1e-3 * hit.normal, sun).body > 0;
        const double light = 0.3 + (shadow ? 0 : 0.8 * std::max(0.0, dot(hit.normal, sun)));
        const double haze = std::exp(-0.04 * hit.distance);
        color = haze * light * hit.color + (1 - haze) * color;
      }
      uint8_t* pixel = &frame.rgb[size_t{3} * static_cast<size_t>(v * k.width + u)];
      const double channels[3] = {color.x, color.y, color.z};
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<uint8_t>(255 * std::pow(std::clamp(channels[c], 0.0, 1.0), 1 / 2.2));
    }
  }
}

Result<Pose> FakeSimulation::body_pose(Body body) {
  return Pose{balls()[static_cast<size_t>(body.id - 1)].center, {}};
}

Result<PickResult> FakeSimulation::pick(const CameraFrame& frame, double u, double v) {
  const auto list = balls();
  const Hit hit = cast(list, frame.X_WC.p,
                       unit(*point_at(frame.X_WC, frame.intrinsics, u, v, 1) - frame.X_WC.p));
  if (hit.body < 0) return Error{.message = "nothing is there"};
  const Vec3 origin = hit.body > 0 ? list[static_cast<size_t>(hit.body - 1)].center : Vec3{};
  const std::string name = hit.body > 0 ? list[static_cast<size_t>(hit.body - 1)].name : "world";
  return PickResult{{hit.body}, name, hit.point - origin, hit.point};
}

}  // namespace gloam
