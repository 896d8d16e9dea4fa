// Time of a policy's network in the control loop: OpenVINO in f32 on one thread.
//
//   policy_rate [--width N] [--layers N] [--json]
//
// LAYERS hidden layers of WIDTH (3 of 512), Elu, 48 inputs, 12 outputs. Prints the median and the
// 99th percentile of 10,000 runs, each with new inputs.

#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "base/files.h"
#include "bench/command_line.h"
#include "bench/median.h"
#include "policy/network.h"
#include "policy/test/onnx_bytes.h"

namespace gloam {
namespace {

constexpr int kInputs = 48, kOutputs = 12, kRuns = 10'000;

/// A network as torch exports it: Gemm and Elu, with weights between -1 / rows and 1 / rows.
std::string network(int width, int layers) {
  OnnxGraph graph;
  std::string last = "obs";
  int64_t rows = kInputs;
  uint64_t x = 1;
  for (int i = 0; i <= layers; ++i) {
    const int64_t columns = i == layers ? kOutputs : width;
    std::vector<float> weights(static_cast<size_t>(rows * columns));
    for (float& w : weights) {
      x ^= x << 13, x ^= x >> 7, x ^= x << 17;
      w = (static_cast<float>(x >> 40) / 8388608.0f - 1) / static_cast<float>(rows);
    }
    const std::string name = fmt::format("w{}", i);
    graph.tensors.push_back(onnx_tensor(name, {rows, columns}, weights));
    const std::string out = i == layers ? "actions" : fmt::format("g{}", i);
    graph.nodes.push_back(onnx_node("Gemm", {last, name}, out));
    last = fmt::format("e{}", i);
    if (i < layers) graph.nodes.push_back(onnx_node("Elu", {out}, last));
    rows = columns;
  }
  graph.inputs = {onnx_port("obs", {-1, kInputs})};
  graph.outputs = {onnx_port("actions", {-1, kOutputs})};
  return onnx_model(graph);
}

Status run(int width, int layers, bool json) {
  using Clock = std::chrono::steady_clock;
  const auto file =
      std::filesystem::temp_directory_path() / fmt::format("gloam_policy_rate_{}.onnx", ::getpid());
  GLOAM_TRY_STATUS(write_text_file_atomic(file, network(width, layers)));
  auto loaded = load_onnx_network(file);
  std::filesystem::remove(file);
  if (!loaded.ok()) return loaded.error();
  Network& policy = *loaded->network;
  std::vector<double> times;  // [µs]
  for (int i = 0; i < kRuns; ++i) {
    const std::span<float> input = policy.input(0);
    for (size_t k = 0; k < input.size(); ++k)
      input[k] = static_cast<float>((static_cast<size_t>(i) * 31 + k * 7) % 64) / 32 - 1;
    const auto start = Clock::now();
    if (!policy.run()) return Error{ErrorKind::kIo, "OpenVINO could not run the network"};
    times.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  const double middle = median(times);
  std::nth_element(times.begin(), times.begin() + kRuns * 99 / 100, times.end());
  const double slow = times[kRuns * 99 / 100];
  if (json)
    fmt::print("{{\"median_us\": {:.2f}, \"p99_us\": {:.2f}}}\n", middle, slow);
  else
    fmt::print("{} x {}: {:.1f} µs, 99 % below {:.1f} µs\n", layers, width, middle, slow);
  return {};
}

}  // namespace
}  // namespace gloam

int main(int argc, char** argv) {
  gloam::CommandLine line(argc, argv);
  int width = 512, layers = 3;
  line.value("--width", &width);
  line.value("--layers", &layers);
  return gloam::exit_code(gloam::run(width, layers, line.flag("--json")));
}
