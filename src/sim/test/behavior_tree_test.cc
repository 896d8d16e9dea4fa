// Behaviour trees: what their nodes mean, and what is wrong with files.

#include <gtest/gtest.h>

#include <map>

#include "base/rng.h"
#include "sim/agents/behavior_tree.h"

namespace gloam {
namespace {

/// Answers as it is told, and notes what it is asked for.
class FakeHost final : public TreeHost {
 public:
  double time() const override { return now; }
  NodeStatus go_to(Vec3d goal, double, bool is_new) override {
    begun += is_new;
    said += "go" + std::to_string(static_cast<int>(goal.x)) + " ";
    return answers[static_cast<int>(goal.x)];
  }
  NodeStatus wander(double, bool) override { return NodeStatus::kRunning; }
  NodeStatus follow(const std::string& target, double, double) override {
    said += "follow " + target;
    return NodeStatus::kRunning;
  }
  NodeStatus face(const std::string&) override { return NodeStatus::kSuccess; }
  void stand() override { said += "stand "; }
  double robot_distance() const override { return robot; }
  double agent_distance() const override { return 9; }
  double distance_to(Vec3d) const override { return 5; }
  bool was_touched() const override { return false; }

  double now = 0, robot = 9;
  int begun = 0;
  std::string said;
  std::map<int, NodeStatus> answers;
};

std::string in_root(const std::string& nodes) {
  return "<root BTCPP_format=\"4\">\n<BehaviorTree ID=\"Main\">\n" + nodes +
         "\n</BehaviorTree>\n</root>\n";
}
std::string go(int x) { return "<GoTo goal=\"" + std::to_string(x) + ";0;0\"/>"; }

TreeState made(const std::string& text) {
  const auto tree = read_behavior_tree(text, "tree.xml");
  if (!tree.ok()) {
    ADD_FAILURE() << tree.error().to_string();
    abort();
  }
  return TreeState(*tree);
}

constexpr NodeStatus kRun = NodeStatus::kRunning, kGood = NodeStatus::kSuccess,
                     kBad = NodeStatus::kFailure;

TEST(BehaviorTree, ASequenceRemembersWhereItIs) {
  FakeHost host;
  TreeState tree = made(in_root("<Sequence>" + go(1) + go(2) + "</Sequence>"));
  host.answers = {{1, kGood}, {2, kRun}};
  EXPECT_EQ(tree.tick(&host), kRun);
  EXPECT_EQ(tree.tick(&host), kRun);
  EXPECT_EQ(host.said, "go1 go2 go2 ") << "the first is not ticked again";
  EXPECT_EQ(host.begun, 2);
  host.answers[2] = kBad;
  EXPECT_EQ(tree.tick(&host), kBad);
  host.said.clear();
  tree.tick(&host);
  EXPECT_EQ(host.said, "go1 go2 ") << "after a failure it begins anew";
}

TEST(BehaviorTree, AReactiveSequenceAsksItsConditionsEachTime) {
  FakeHost host;
  TreeState tree =
      made(in_root("<ReactiveSequence><Inverter><RobotNear distance=\"2\"/></Inverter>" + go(1) +
                   "</ReactiveSequence>"));
  host.answers = {{1, kRun}};
  EXPECT_EQ(tree.tick(&host), kRun);
  host.robot = 1;
  EXPECT_EQ(tree.tick(&host), kBad);
  host.robot = 9;
  EXPECT_EQ(tree.tick(&host), kRun);
  EXPECT_EQ(host.begun, 2) << "what was halted begins anew";
}

TEST(BehaviorTree, FallbacksGoOnAtFailure) {
  FakeHost host;
  TreeState tree = made(in_root("<Fallback>" + go(1) + go(2) + "</Fallback>"));
  host.answers = {{1, kBad}, {2, kGood}};
  EXPECT_EQ(tree.tick(&host), kGood);
  EXPECT_EQ(host.said, "go1 go2 ");
  TreeState reactive = made(in_root("<ReactiveFallback>" + go(1) + go(2) + "</ReactiveFallback>"));
  host.said.clear();
  host.answers = {{1, kBad}, {2, kRun}};
  reactive.tick(&host), reactive.tick(&host);
  EXPECT_EQ(host.said, "go1 go2 go1 go2 ");
}

TEST(BehaviorTree, ParallelsCount) {
  FakeHost host;
  TreeState tree = made(in_root("<Parallel success_count=\"2\" failure_count=\"2\">" + go(1) +
                                go(2) + go(3) + "</Parallel>"));
  host.answers = {{1, kGood}, {2, kRun}, {3, kBad}};
  EXPECT_EQ(tree.tick(&host), kRun);
  host.answers[2] = kGood;
  EXPECT_EQ(tree.tick(&host), kGood);
  EXPECT_EQ(host.said, "go1 go2 go3 go2 ") << "what has ended is not ticked again";
}

TEST(BehaviorTree, DecoratorsOfTime) {
  FakeHost host;
  TreeState wait = made(in_root("<Sequence><Sleep msec=\"1500\"/>" + go(1) + "</Sequence>"));
  host.answers = {{1, kGood}};
  EXPECT_EQ(wait.tick(&host), kRun);
  host.now = 1.4;
  EXPECT_EQ(wait.tick(&host), kRun);
  host.now = 1.5;
  EXPECT_EQ(wait.tick(&host), kGood);
  host.answers = {{1, kRun}};
  TreeState timeout = made(in_root("<Timeout msec=\"1000\">" + go(1) + "</Timeout>"));
  EXPECT_EQ(timeout.tick(&host), kRun);
  host.now = 2.5;
  EXPECT_EQ(timeout.tick(&host), kBad);
  TreeState delay = made(in_root("<Delay delay_msec=\"500\">" + go(1) + "</Delay>"));
  host.said.clear();
  delay.tick(&host);
  EXPECT_EQ(host.said, "");
  host.now = 3;
  delay.tick(&host);
  EXPECT_EQ(host.said, "go1 ");
}

TEST(BehaviorTree, RepeatAndRetry) {
  FakeHost host;
  host.answers = {{1, kGood}, {2, kBad}};
  TreeState repeat = made(in_root("<Repeat num_cycles=\"3\">" + go(1) + "</Repeat>"));
  EXPECT_EQ(repeat.tick(&host), kRun);
  EXPECT_EQ(repeat.tick(&host), kRun);
  EXPECT_EQ(repeat.tick(&host), kGood);
  TreeState retry = made(
      in_root("<RetryUntilSuccessful num_attempts=\"2\">" + go(2) + "</RetryUntilSuccessful>"));
  EXPECT_EQ(retry.tick(&host), kRun);
  EXPECT_EQ(retry.tick(&host), kBad);
  TreeState forced = made(in_root("<ForceSuccess>" + go(2) + "</ForceSuccess>"));
  EXPECT_EQ(forced.tick(&host), kGood);
}

TEST(BehaviorTree, SubTreesHavePorts) {
  FakeHost host;
  host.answers = {{4, kGood}, {5, kGood}};
  TreeState tree = made(R"(<root BTCPP_format="4" main_tree_to_execute="Main">
    <BehaviorTree ID="Main"><Sequence>
      <SubTree ID="Visit" place="4;0;0"/>
      <SubTree ID="Visit" place="5;0;0"/>
    </Sequence></BehaviorTree>
    <BehaviorTree ID="Visit"><Action ID="GoTo" goal="{place}"/></BehaviorTree>
    <TreeNodesModel/>
  </root>)");
  EXPECT_EQ(tree.tick(&host), kGood);
  EXPECT_EQ(host.said, "go4 go5 ");
}

struct Wrong {
  const char* nodes;
  const char* says;
  int line;
};

TEST(BehaviorTree, WhatIsWrongIsSaidWithItsLine) {
  const Wrong cases[] = {
      {"<Sequnce/>", "unknown node 'Sequnce'", 3},
      {"<Sequence>\n<GoTo/></Sequence>", "without 'goal'", 4},
      {"<GoTo goal=\"1;2\"/>", "whose goal is '1;2'", 3},
      {"<GoTo goal=\"1;2;nan\"/>", "whose goal", 3},
      {"<GoTo goal=\"1;2;3\" sped=\"1\"/>", "unknown port 'sped'", 3},
      {"<Sequence/>", "with no child nodes", 3},
      {"<Inverter>\n<Stand/><Stand/></Inverter>", "more than one", 3},
      {"<Stand><Stand/></Stand>", "with child nodes", 3},
      {"<Sleep msec=\"-4\"/>", "whose msec is '-4'", 3},
      {"<Repeat num_cycles=\"0\"><Stand/></Repeat>", "num_cycles", 3},
      {"<SubTree ID=\"Main\"/>", "contains itself", 3},
      {"<SubTree ID=\"Other\"/>", "no tree 'Other'", 3},
      {"<GoTo goal=\"{place}\"/>", "which is not set", 3},
      {"<Stand/>\n<Stand/>", "two roots", 4},
      {"<Stand _skipIf=\"true\"/>", "unknown port '_skipIf'", 3},
      {"<Sequence><Stand></Sequence>", "not well-formed", 3},
  };
  for (const Wrong& wrong : cases) {
    const auto tree = read_behavior_tree(in_root(wrong.nodes), "tree.xml");
    ASSERT_FALSE(tree.ok()) << wrong.nodes;
    EXPECT_NE(tree.error().message.find(wrong.says), std::string::npos)
        << wrong.nodes << ": " << tree.error().to_string();
    EXPECT_EQ(tree.error().loc.line, wrong.line) << tree.error().to_string();
    EXPECT_EQ(tree.error().loc.file, "tree.xml");
  }
  EXPECT_FALSE(read_behavior_tree("", "t").ok());
  EXPECT_FALSE(read_behavior_tree("<root/>", "t").ok()) << "no format";
  EXPECT_FALSE(read_behavior_tree("<root BTCPP_format=\"3\"/>", "t").ok());
}

TEST(BehaviorTree, DepthAndSizeHaveLimits) {
  std::string deep, ends;
  for (int i = 0; i < 100; ++i) deep += "<Inverter>", ends += "</Inverter>";
  EXPECT_FALSE(read_behavior_tree(in_root(deep + "<Stand/>" + ends), "t").ok());
  std::string many = "<Sequence>";
  for (int i = 0; i < 5000; ++i) many += "<Stand/>";
  EXPECT_FALSE(read_behavior_tree(in_root(many + "</Sequence>"), "t").ok());
  // Trees that double at each level would be 2^40 nodes.
  std::string bomb = "<root BTCPP_format=\"4\" main_tree_to_execute=\"T0\">";
  for (int i = 0; i < 40; ++i) {
    const std::string next = "<SubTree ID=\"T" + std::to_string(i + 1) + "\"/>";
    bomb += "<BehaviorTree ID=\"T" + std::to_string(i) + "\"><Sequence>" + next + next +
            "</Sequence></BehaviorTree>";
  }
  bomb += "<BehaviorTree ID=\"T40\"><Stand/></BehaviorTree></root>";
  EXPECT_FALSE(read_behavior_tree(bomb, "t").ok());
}

// Changed at random, a file is read or refused, and what is read can be ticked.
TEST(BehaviorTree, MutationsDoNoHarm) {
  const std::string good = R"(<root BTCPP_format="4" main_tree_to_execute="Main">
<BehaviorTree ID="Main"><ReactiveFallback>
<Sequence><RobotNear distance="1.5"/><StopFor distance="2"/></Sequence>
<Repeat num_cycles="-1"><Sequence><SubTree ID="Go" place="3;0;0"/><Wait msec="200"/></Sequence></Repeat>
<Parallel success_count="1"><Timeout msec="20"><Wander/></Timeout><AlwaysFailure/></Parallel>
</ReactiveFallback></BehaviorTree>
<BehaviorTree ID="Go"><RetryUntilSuccessful num_attempts="3"><GoTo goal="{place}" speed="1"/></RetryUntilSuccessful></BehaviorTree>
</root>)";
  ASSERT_TRUE(read_behavior_tree(good, "t").ok());
  const RandomStream stream{11, stream_id("test.trees")};
  int read = 0;
  for (uint64_t i = 0; i < 20000; ++i) {
    std::string text = good;
    const int changes = 1 + static_cast<int>(3 * stream.uniform(i, 0));
    for (uint32_t c = 1; c <= static_cast<uint32_t>(changes); ++c) {
      const auto at = static_cast<size_t>(stream.uniform(i, 3 * c) * double(text.size()));
      const double what = stream.uniform(i, 3 * c + 1), how = stream.uniform(i, 3 * c + 2);
      if (what < 0.3)
        text[at] = static_cast<char>(static_cast<uint8_t>(256 * how));
      else if (what < 0.6)
        text.erase(at, 1 + static_cast<size_t>(12 * how));
      else
        text.insert(at, text.substr(static_cast<size_t>(how * double(text.size())), 20));
    }
    const auto tree = read_behavior_tree(text, "t");
    if (!tree.ok()) continue;
    ++read;
    FakeHost host;
    host.answers = {{3, kRun}};
    TreeState state(*tree);
    for (int t = 0; t < 5; ++t) host.now += 0.1, state.tick(&host);
  }
  EXPECT_GT(read, 50) << "some changes leave a tree";
}

}  // namespace
}  // namespace gloam
