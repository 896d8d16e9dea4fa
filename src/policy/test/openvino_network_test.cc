#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "policy/network.h"
#include "policy/openvino_api.h"
#include "policy/test/linear_network.h"
#include "policy/test/onnx_bytes.h"

namespace gloam {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class OpenvinoNetworkTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto library = openvino(); !library.ok()) GTEST_SKIP() << library.error().to_string();
  }
  std::string error_of(const OnnxGraph& graph) {
    const auto loaded = load_onnx_network(folder_.write("p.onnx", onnx_model(graph)));
    return loaded.ok() ? "" : loaded.error().to_string();
  }
  PolicyFolder folder_;
};

TEST_F(OpenvinoNetworkTest, ComputesALinearNetwork) {
  auto loaded = load_onnx_network(folder_.write("p.onnx", onnx_model(onnx_linear())));
  ASSERT_TRUE(loaded.ok()) << loaded.error().to_string();
  Network& network = *loaded->network;
  ASSERT_EQ(network.inputs()[0].size, 4u);
  ASSERT_EQ(network.outputs()[0].size, 2u);
  const float x[4] = {1, 2, 3, 4};
  std::ranges::copy(x, network.input(0).begin());
  ASSERT_TRUE(network.run());
  EXPECT_THAT(network.output(0), ElementsAre(4, -2));
  const auto other = network.share();
  std::ranges::fill(other->input(0), 1.0f);
  ASSERT_TRUE(other->run());
  EXPECT_THAT(other->output(0), ElementsAre(2, 0));
  EXPECT_THAT(network.output(0), ElementsAre(4, -2));
}

TEST_F(OpenvinoNetworkTest, ReadsWeightsFromAFileInItsFolder) {
  const float weights[8] = {1, 0, 0, 1, 1, 0, 0, -1};
  folder_.write("w.bin", std::string(reinterpret_cast<const char*>(weights), sizeof weights));
  OnnxGraph graph = onnx_linear();
  const std::string entry = wire_field(1, "location") + wire_field(2, "w.bin");
  graph.tensors = {onnx_tensor("w", {4, 2}) + wire_field(13, entry) + wire_number(14, 1)};
  auto loaded = load_onnx_network(folder_.write("p.onnx", onnx_model(graph)));
  ASSERT_TRUE(loaded.ok()) << loaded.error().to_string();
  std::ranges::fill(loaded->network->input(0), 1.0f);
  ASSERT_TRUE(loaded->network->run());
  EXPECT_THAT(loaded->network->output(0), ElementsAre(2, 0));
}

TEST_F(OpenvinoNetworkTest, RejectsResultsThatGrowBeforeTheyAreComputed) {
  const int64_t sizes[3] = {1 << 30, 1, 2};
  std::string size = wire_number(1, 3) + wire_number(2, 7) + wire_field(8, "size") +
                     wire_field(9, {reinterpret_cast<const char*>(sizes), sizeof sizes});
  OnnxGraph graph = onnx_linear();
  graph.nodes = {onnx_node("MatMul", {"obs", "w"}, "y"), onnx_node("Expand", {"y", "size"}, "many"),
                 onnx_node("ReduceMax", {"many"}, "actions",
                           wire_field(1, "keepdims") + wire_number(3, 0) + wire_number(20, 2))};
  graph.tensors.push_back(size);
  EXPECT_THAT(error_of(graph), HasSubstr("operations would take over 256 MiB"));
}

TEST_F(OpenvinoNetworkTest, RejectsInputsThatNoObservationFits) {
  OnnxGraph open = onnx_linear();
  open.inputs = {onnx_port("obs", {1, -1})};
  EXPECT_THAT(error_of(open), HasSubstr("open size"));
  OnnxGraph unknown = onnx_linear();
  unknown.nodes = {onnx_node("NoSuchOperation", {"obs", "w"}, "actions")};
  EXPECT_THAT(error_of(unknown), HasSubstr("OpenVINO cannot read the network"));
}

}  // namespace
}  // namespace gloam
