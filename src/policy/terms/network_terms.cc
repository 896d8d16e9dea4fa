// Terms that networks bring themselves: outputs of networks, and references of a motion in time.

#include <algorithm>
#include <cmath>

#include "policy/policy_spec.h"
#include "policy/terms/body_pose.h"

namespace gloam {
namespace {

/// Elements of an output; the observer selects them.
class NetworkOutput final : public Term {
 public:
  size_t size() const override { return 0; }
  void write(const TermInputs& in, std::span<double> out) override {
    std::ranges::copy(in.source, out.begin());
  }
  std::unique_ptr<Term> clone() const override { return std::make_unique<NetworkOutput>(*this); }
};

/// Control periods since the start, as motion tracking policies count their reference's frames.
class TimeStep final : public Term {
 public:
  TimeStep(double start, double end) : start_(start), end_(end) {}
  size_t size() const override { return 1; }
  void write(const TermInputs& in, std::span<double> out) override {
    out[0] = std::min(start_ + static_cast<double>(in.period), end_);
  }
  std::unique_ptr<Term> clone() const override { return std::make_unique<TimeStep>(*this); }

 private:
  double start_, end_;
};

/// Orientation of a motion's reference body as seen from the same body of the robot: the first two
/// columns of R_RM, row by row (motion_ref_ori_b of holosoma and BeyondMimic). Both headings count
/// from those at the start, so that a robot may face anywhere.
class ReferenceOrientation final : public Term {
 public:
  explicit ReferenceOrientation(std::string body) : body_name_(std::move(body)) {}
  size_t size() const override { return 6; }
  bool needs_base() const override { return true; }
  void reset() override { has_start_ = false; }
  void take_over(const Term& before) override {
    const auto* old = dynamic_cast<const ReferenceOrientation*>(&before);
    if (old == nullptr) return;
    has_start_ = old->has_start_;
    robot_yaw_ = old->robot_yaw_, motion_yaw_ = old->motion_yaw_;
  }
  Status bind(const TermBinding& binding) override {
    GLOAM_TRY(body_, find_body(binding, body_name_));
    return {};
  }
  void write(const TermInputs& in, std::span<double> out) override {
    mjtNum robot[4], motion[4] = {1, 0, 0, 0};
    body_orientation(*in.model, *in.data, body_, robot);
    if (in.source.size() >= 4)  // xyzw
      for (size_t i = 0; i < 4; ++i) motion[(i + 1) % 4] = static_cast<double>(in.source[i]);
    mju_normalize4(motion);
    if (!has_start_) {
      robot_yaw_ = yaw_of(robot), motion_yaw_ = yaw_of(motion);
      has_start_ = true;
    }
    turn_back(robot_yaw_, robot);
    turn_back(motion_yaw_, motion);
    mjtNum inverse[4], relative[4], R_RM[9];
    mju_negQuat(inverse, robot);
    mju_mulQuat(relative, inverse, motion);
    mju_quat2Mat(R_RM, relative);
    for (size_t row = 0; row < 3; ++row)
      for (size_t column = 0; column < 2; ++column) out[2 * row + column] = R_RM[3 * row + column];
  }
  std::unique_ptr<Term> clone() const override {
    return std::make_unique<ReferenceOrientation>(*this);
  }

 private:
  static double yaw_of(const mjtNum q[4]) {
    return std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3]));
  }
  static void turn_back(double yaw, mjtNum q[4]) {
    const mjtNum turn[4] = {std::cos(yaw / 2), 0, 0, -std::sin(yaw / 2)};
    mjtNum turned[4];
    mju_mulQuat(turned, turn, q);
    mju_copy4(q, turned);
  }

  std::string body_name_;
  int body_ = -1;
  bool has_start_ = false;
  double robot_yaw_ = 0, motion_yaw_ = 0;  // at the start [rad]
};

std::unique_ptr<Term> make_output(const TermRequest&) { return std::make_unique<NetworkOutput>(); }

std::unique_ptr<Term> make_time_step(const TermRequest& request) {
  const NumberRule rule{.min = 0, .max = 1e9};
  const double start = request.settings->number(*request.table, "start", 0, rule);
  return std::make_unique<TimeStep>(start,
                                    request.settings->number(*request.table, "end", 1e9, rule));
}

std::unique_ptr<Term> make_reference_orientation(const TermRequest& request) {
  return std::make_unique<ReferenceOrientation>(request.settings->text(*request.table, "body"));
}

constexpr TermKind kNetworkTerms[] = {
    {.name = "network_output",
     .unit = "its own",
     .doc = "elements of an output of a network of the policy",
     .make = make_output,
     .reads_output = true},
    {.name = "time_step",
     .fixed = 1,
     .unit = "1",
     .doc = "control periods since the start, for policies that track a motion",
     .make = make_time_step,
     .keys = "start end"},
    {.name = "reference_orientation",
     .aliases = "motion_ref_ori_b motion_anchor_ori_b",
     .fixed = 6,
     .unit = "1",
     .doc = "orientation of a motion's reference (an output, xyzw) in the frame of a body",
     .make = make_reference_orientation,
     .keys = "body",
     .reads_output = true},
};

}  // namespace

std::span<const TermKind> network_terms() { return kNetworkTerms; }

}  // namespace gloam
