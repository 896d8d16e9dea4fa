// Parts of a report; the whole page is tests/e2e/report_test.py's.

#include "gloam/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/rng.h"
#include "render/film/video.h"
#include "report/bootstrap.h"
#include "report/metric_names.h"
#include "report/page.h"
#include "report/svg_chart.h"
#include "report/video_frames.h"

namespace gloam {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class ReportFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("gloam_report_" + std::to_string(::getpid()) + "_" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path run(const std::string& name, const std::string& summary, const std::string& table = "") {
    fs::create_directories(folder_ / name);
    std::ofstream(folder_ / name / "summary.json") << summary;
    if (!table.empty()) std::ofstream(folder_ / name / "metrics.csv") << table;
    return folder_ / name;
  }
  static std::string summary(const std::string& results, const std::string& hash = "1") {
    return R"({"format":"gloam-run 1","title":"walk","state":"finished","exit_reason":"completed",
      "scene":{"file":"walk.toml","hash":"ab"},"seed":1,"steps":100,"simulated_s":1,
      "final_state_hash":")" +
           hash + R"(","results":{)" + results + "}}";
  }
  ReportRequest request(const std::vector<fs::path>& runs) const {
    return {.runs = runs, .out = folder_ / "report.html"};
  }
  std::string page() const { return read_text_file(folder_ / "report.html").value(); }

  fs::path folder_;
};

TEST(MetricTable, IsReadAsRfc4180SaysIt) {
  const auto table = parse_metric_table(
      "\xEF\xBB\xBFtime_s,\"a,\"\"b\"\"\"\r\n0,1\r\n0.5,\r\n1,x\r\n2,\"7\"\r\n", "t");
  ASSERT_TRUE(table.ok()) << table.error().to_string();
  EXPECT_EQ(table->columns[1], "a,\"b\"");
  EXPECT_EQ(table->values[0], (std::vector<double>{0, 0.5, 1, 2}));
  EXPECT_EQ(table->values[1][0], 1);
  EXPECT_TRUE(std::isnan(table->values[1][1]));
  EXPECT_TRUE(std::isnan(table->values[1][2]));
  EXPECT_EQ(table->values[1][3], 7);
  EXPECT_EQ(table->find("time_s"), &table->values[0]);
  EXPECT_EQ(table->find("time"), nullptr);
}

TEST(MetricTable, WhatIsWrongIsSaidByLine) {
  EXPECT_THAT(parse_metric_table("", "t").error().to_string(), HasSubstr("empty"));
  EXPECT_THAT(parse_metric_table("a,b\n1,2\n1\n1,2\n", "t").error().to_string(), HasSubstr("t:3"));
  EXPECT_THAT(parse_metric_table("a,a\n1,2\n", "t").error().to_string(), HasSubstr("two columns"));
  EXPECT_THAT(parse_metric_table("a,b\n\"1,2\n3,4\n", "t").error().to_string(), HasSubstr("t:2"));
  EXPECT_THAT(parse_metric_table("a,b\n\"1\"x,2\n3,4\n", "t").error().to_string(),
              HasSubstr("t:2"));
  EXPECT_EQ(parse_metric_table("a,b\n1,2\n3", "t")->rows(), 1u);  // a run that was killed
}

TEST(MetricNames, HaveUnitsAndSaysWhatIsBetterWhereThatIsKnown) {
  const MetricName name = split_metric_name("ada.vx_error_rms_percent");
  EXPECT_EQ(name.subject, "ada");
  EXPECT_EQ(name.text, "vx error rms");
  EXPECT_EQ(name.unit, "%");
  EXPECT_EQ(split_metric_name("speed_mps").unit, "m/s");
  EXPECT_EQ(split_metric_name("_m").text, " m");
  EXPECT_EQ(better_of("ada.vx_error_rms_percent"), Better::kLess);
  EXPECT_EQ(better_of("ada.falls"), Better::kLess);
  EXPECT_EQ(better_of("ada.collisions"), Better::kLess);
  EXPECT_EQ(better_of("ada.success"), Better::kMore);
  EXPECT_EQ(better_of("ada.path_length_m"), Better::kUnknown);
  EXPECT_EQ(better_of("falls.height_m"), Better::kUnknown);  // the robot's name
  EXPECT_EQ(better_of("ada.split_m"), Better::kUnknown);     // not SPL
}

TEST(Bootstrap, OfTwoValuesHasTheClosedForm) {
  // Means of two draws of {0, 1}: 0, 1/2, 1 with chances 1/4, 1/2, 1/4.
  const double values[] = {0, 1};
  const MeanInterval of = bootstrap_mean(values, "x");
  EXPECT_EQ(of.mean, 0.5);
  EXPECT_EQ(of.low, 0);
  EXPECT_EQ(of.high, 1);
}

TEST(Bootstrap, OfManyValuesIsTheNormalInterval) {
  std::vector<double> values;
  const RandomStream random{1, stream_id("test")};
  for (uint64_t i = 0; i < 400; ++i) values.push_back(random.uniform(i, 0));
  const MeanInterval of = bootstrap_mean(values, "x");
  const double half = 1.96 * std::sqrt(1.0 / 12 / 400);
  EXPECT_NEAR(of.high - of.mean, half, 0.1 * half);
  EXPECT_NEAR(of.mean - of.low, half, 0.1 * half);
  const MeanInterval again = bootstrap_mean(values, "x");
  EXPECT_EQ(of.low, again.low);
  EXPECT_NE(of.low, bootstrap_mean(values, "y").low);
  const double one[] = {3};
  EXPECT_EQ(bootstrap_mean(one, "x").low, 3);
}

TEST(HtmlText, LeavesNoMarkup) {
  EXPECT_EQ(html_text("<b a=\"1\" c='2'>&\n\xff"),
            "&lt;b a=&quot;1&quot; c=&#39;2&#39;&gt;&amp; \xEF\xBF\xBD");
}

TEST(ShortNumber, HasFourDigits) {
  EXPECT_EQ(short_number(1234567.8), "1.23e+06");
  EXPECT_EQ(short_number(19.40672), "19.41");
  EXPECT_EQ(short_number(0.0123456), "0.01235");
  EXPECT_EQ(short_number(-2), "-2");
  EXPECT_EQ(short_number(0.5), "0.5");
  EXPECT_EQ(short_number(1e-15), "0");
  EXPECT_EQ(short_number(0.00012345), "0.000123");
}

TEST(SvgChart, DrawsGapsAndConstantsAndNothing) {
  Chart chart;
  EXPECT_THAT(chart_svg(chart), Not(HasSubstr("nan")));
  chart.curves.push_back({"c", {0, 1, 2, 3}, {5, NAN, 5, 5}, 0, false});
  const std::string svg = chart_svg(chart);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(std::count(svg.begin(), svg.end(), 'M'), 2);
  chart.curves[0].y = {1e300, -1e300, 0, INFINITY};
  EXPECT_THAT(chart_svg(chart), Not(HasSubstr("nan")));
  chart.equal_scale = true;
  EXPECT_THAT(chart_svg(chart), Not(HasSubstr("nan")));
}

TEST(SvgChart, KeepsAPeakOfOneSample) {
  Chart chart;
  ChartCurve curve;
  for (int i = 0; i < 100'000; ++i) {
    curve.x.push_back(i);
    curve.y.push_back(i == 51'234 ? 10 : 0);
  }
  chart.curves = {curve};
  const std::string svg = chart_svg(chart);
  EXPECT_LT(svg.size(), 40'000u);
  EXPECT_THAT(svg, HasSubstr("L"));
  // The peak's pixel: 5 % of the range under the top margin.
  EXPECT_THAT(svg, HasSubstr(" 31.7"));
}

// A picture that changes from left to right, brighter with each number.
std::vector<uint8_t> test_picture(int number) {
  std::vector<uint8_t> rgb;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      rgb.push_back(static_cast<uint8_t>(3 * x));
      rgb.push_back(static_cast<uint8_t>(20 * number));
      rgb.push_back(static_cast<uint8_t>(4 * y));
    }
  return rgb;
}

class VideoFramesTest : public ReportFolder {
 protected:
  fs::path video(bool finished) const {
    const fs::path file = folder_ / (finished ? "whole.mp4" : "cut.mp4");
    auto writer = VideoWriter::start(create_file_sink(file).value(),
                                     {.width = 64, .height = 48, .rate = {10, 1}, .qp = 10});
    for (int i = 0; i < 9; ++i) EXPECT_TRUE(writer->add(i < 5 ? i : i + 3, test_picture(i)).ok());
    if (finished) {
      EXPECT_TRUE(writer->finish().ok());
    }
    return file;
  }
};

TEST_F(VideoFramesTest, AreThePicturesThatWereWritten) {
  for (const bool finished : {true, false}) {
    const auto reader = VideoReader::open(video(finished));
    ASSERT_TRUE(reader.ok()) << reader.error().to_string();
    ASSERT_EQ(reader->index().samples.size(), 9u);
    EXPECT_NEAR(reader->index().samples[4].time, 0.4, 1e-9);
    EXPECT_NEAR(reader->index().samples[5].time, 0.8, 1e-9);
    for (const size_t i : {8u, 0u, 5u}) {
      const auto image = reader->decode(i);
      ASSERT_TRUE(image.ok()) << image.error().to_string();
      ASSERT_EQ(image->width, 64);
      const std::vector<uint8_t> wanted = test_picture(static_cast<int>(i));
      double squares = 0;
      for (size_t k = 0; k < wanted.size(); ++k)
        squares += std::pow(static_cast<double>(wanted[k]) - image->texels[k], 2);
      EXPECT_LT(std::sqrt(squares / static_cast<double>(wanted.size())), 6) << i;
    }
    EXPECT_FALSE(reader->decode(9).ok());
  }
}

TEST_F(VideoFramesTest, MutationsAreReadOrRefused) {
  const auto good = read_file(video(true)).value();
  const RandomStream random{3, stream_id("report.mutations")};
  const char* asked = std::getenv("GLOAM_MUTATIONS");
  const int count = asked != nullptr ? std::atoi(asked) : 200;
  for (int i = 0; i < count; ++i) {
    auto bytes = good;
    for (uint32_t k = 0; k < 6; ++k) {
      const Philox4 draw = random.draw(static_cast<uint64_t>(i), k);
      bytes[draw.v[0] % bytes.size()] = static_cast<uint8_t>(draw.v[1]);
    }
    if (i % 3 == 0) bytes.resize(random.draw(static_cast<uint64_t>(i), 9).v[0] % bytes.size());
    const auto index = index_video(bytes, "x");
    if (!index.ok()) continue;
    for (const auto& sample : index->samples) ASSERT_LE(sample.offset + sample.size, bytes.size());
  }
}

TEST_F(ReportFolder, NamesOfStrangersAreNoMarkup) {
  const std::string evil = "<script>alert(1)</script>";
  const fs::path run_folder = run(
      "<img src=x onerror=alert(2)>",
      R"({"format":"gloam-run 1","title":")" + evil + R"(","state":"finished","exit_reason":")" +
          evil + R"(","seed":"<i>","versions":{"<b>":"<u>","configuration":"<u>"},
              "scene":{"file":"<s>","hash":"<s>"},"settings":{"<q>":"<q>"},"final_state_hash":"<h>",
              "results":{"<x>.y_m":1,"<z>":2}})",
      "time_s,<x>.x_m,<x>.y_m,\"<script>\"\n0,0,0,0\n1,1,1,1\n");
  const auto outcome = write_report(request({run_folder, folder_ / "<missing>"}));
  ASSERT_TRUE(outcome.ok()) << outcome.error().to_string();
  EXPECT_EQ(outcome->left_out.size(), 1u);
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)"));
  for (const char* tag : {"<script>alert", "<img src=x", "<i>", "<u>", "<s>", "<q>", "<h>", "<x>",
                          "<z>", "<missing>", "<b><u>"})
    EXPECT_THAT(html, Not(HasSubstr(tag)));
}

TEST_F(ReportFolder, GroupsAreRepetitionsAndMotionsAreEqual) {
  std::vector<fs::path> runs;
  for (int i = 1; i <= 4; ++i)
    runs.push_back(run("walk-00" + std::to_string(i),
                       summary("\"ada.falls\":" + std::to_string(i), std::to_string(i))));
  runs.push_back(run("again", summary("\"ada.falls\":1", "1")));
  const auto outcome = write_report(request(runs));
  ASSERT_TRUE(outcome.ok());
  EXPECT_TRUE(outcome->left_out.empty());
  EXPECT_EQ(outcome->runs, 5u);
  const std::string html = page();
  EXPECT_THAT(html, HasSubstr("Means over repetitions"));
  EXPECT_THAT(html, HasSubstr("walk<br><span class=\"soft\">4 runs"));
  EXPECT_THAT(html, HasSubstr("2.5 <span class=\"soft\">[1.5, 3.5]"));
  EXPECT_THAT(html, HasSubstr("One motion:</b> walk-001, again: they end in the same state"));
  EXPECT_THAT(html, HasSubstr("best\">1<"));
  EXPECT_FALSE(write_report(request(runs)).ok());  // is there already
}

TEST_F(ReportFolder, WhatCannotBeReadIsTold) {
  const auto good = run("good", summary("\"a\":1"));
  const auto no_json = run("no_json", "{");
  const auto stranger = run("stranger", R"({"format":"other 1"})");
  const auto table = run("table", summary("\"a\":1"), "a,b\n1\n2,3\n");
  const auto odd = run("odd", R"({"format":"gloam-run 1","results":[],"cameras":[1,{"name":3,
    "folder":"../../etc"}],"scene":7,"seed":{},"steps":1e300,"simulated_s":-1,"versions":"x"})");
  const auto outcome = write_report(request({good, no_json, stranger, table, odd}));
  ASSERT_TRUE(outcome.ok());
  EXPECT_EQ(outcome->runs, 3u);
  EXPECT_EQ(outcome->left_out.size(), 3u);
  EXPECT_THAT(page(), HasSubstr("Omitted"));
  EXPECT_FALSE(write_report({.runs = {no_json}, .out = folder_ / "x.html"}).ok());
  EXPECT_FALSE(write_report({.runs = {}, .out = folder_ / "x.html"}).ok());
  EXPECT_FALSE(write_report({.runs = {good}, .out = folder_ / "no" / "x.html"}).ok());
}

TEST(TrajectoryPlot, IsAFileOfItsOwn) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({i, {{1.0 * i, 0.5 * i * i, 0}, {}}});
  const Trajectory one = make_trajectory(poses, "<a>").value();
  const TrajectoryPair pair = associate(one, one).value();
  const std::string svg = trajectory_plot(pair, *absolute_errors(pair, ErrorPart::kTranslation));
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns=\"http://www.w3.org/2000/svg\""));
  EXPECT_THAT(svg, HasSubstr("&lt;a&gt;"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

}  // namespace
}  // namespace gloam
