#include "base/nesting.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace gloam {
namespace {

using testing::HasSubstr;

std::string times(int n, std::string_view text) {
  std::string out;
  for (int i = 0; i < n; ++i) out += text;
  return out;
}

/// `nested(n)` is within the limit for n = `deepest`, not for one more.
void expect_limit(int deepest, const std::function<std::string(int)>& nested,
                  const std::function<bool(std::string_view)>& is_within) {
  EXPECT_TRUE(is_within(nested(deepest))) << nested(3);
  EXPECT_FALSE(is_within(nested(deepest + 1))) << nested(3);
}

bool toml_fits(std::string_view text) { return !toml_excess(text); }
bool xml_fits(std::string_view text) { return !xml_excess(text); }
bool json_fits(std::string_view text) { return !json_excess(text); }

TEST(Nesting, TomlCountsKeysHeadersAndBracketsTogether) {
  const int most = kDeepestToml;
  expect_limit(most, [](int n) { return times(n - 1, "a.") + "b = 1\n"; }, toml_fits);
  expect_limit(most, [](int n) { return "[" + times(n - 1, "a.") + "b]\n"; }, toml_fits);
  expect_limit(most, [](int n) { return "[[" + times(n - 1, "\"a\" . ") + "'b']]\n"; }, toml_fits);
  expect_limit(most, [](int n) { return "[a.b.c]\n" + times(n - 4, "d.") + "e = 1\n"; }, toml_fits);
  expect_limit(
      most, [](int n) { return "a = " + times(n - 1, "[") + times(n - 1, "]"); }, toml_fits);
  expect_limit(most, [](int n) { return "a = [1, {" + times(n - 4, "b.") + "c = 2}]"; }, toml_fits);
  expect_limit(
      most, [](int n) { return "a = {b = 1, " + times(n - 3, "c.") + "d = 2.5}"; }, toml_fits);
}

TEST(Nesting, TomlTextsCommentsAndNumbersDoNotCount) {
  const std::string brackets = times(1000, "[{."), dots = times(1000, "a.");
  for (const std::string& text :
       {"a = \"" + brackets + "\"\n", "a = '" + brackets + "'\n", "# " + brackets + "\nb = 1\n",
        "a = \"\"\"\n" + brackets + "\n\\\"\"\"\" # " + brackets + "\nb = 1",
        "a = '''" + brackets + "\n''" + dots + "'''\n", "\"" + dots + "\" = 1\n",
        "[\"" + dots + "\"]\n", "a = [" + times(1000, "1.5, ") + "]\n",
        "a = [\n" + times(1000, "# [\n'[', {b.c = 1.0}, \n") + "]\n",
        times(1000, "[a.b.c]\nd.e = {f.g = [1, [2]]}\n[[h.i]]\n")})
    EXPECT_TRUE(toml_fits(text)) << text.substr(0, 60);
  // A text that does not end ends with its line, so that nothing hides in it.
  EXPECT_FALSE(toml_fits("a = \"\nb = " + times(300, "[")));
}

TEST(Nesting, XmlCountsOpenElements) {
  expect_limit(
      kDeepestXml, [](int n) { return times(n, "<a b='>'>") + times(n, "</a>"); }, xml_fits);
  expect_limit(kDeepestXml, [](int n) { return times(n - 1, "<a>") + "<b c=\"/\"/>"; }, xml_fits);
  const std::string open = times(1000, "<a>");
  for (const std::string& text :
       {"<!-- " + open + " --><a/>", "<a><![CDATA[" + open + "]]></a>", "<?x " + open + " ?><a/>",
        "<!DOCTYPE a [<!ENTITY b '" + open + "'>]><a/>", times(1000, "<a>x</a><b/>"),
        "<a b='" + open + "'/>"})
    EXPECT_TRUE(xml_fits(text)) << text.substr(0, 60);
  EXPECT_FALSE(xml_fits("<!-- x --><!DOCTYPE a>" + open));
}

TEST(Nesting, XmlBoundsTheAttributesOfAnElement) {
  const auto element = [](int n) { return "<a " + times(n, "b='='\n") + "/>"; };
  expect_limit(kMostXmlAttributes, element, xml_fits);
  EXPECT_TRUE(xml_fits(times(1000, element(3))));
}

TEST(Nesting, JsonCountsBracketsOutsideOfStrings) {
  expect_limit(kDeepestJson, [](int n) { return times(n, "[") + times(n, "]"); }, json_fits);
  expect_limit(kDeepestJson, [](int n) { return times(n, "{\"a\":"); }, json_fits);
  EXPECT_TRUE(json_fits("\"" + times(1000, "[\\\"") + "\""));
  EXPECT_TRUE(json_fits(times(1000, "[{}]")));
}

TEST(Nesting, AnExcessTellsItsLine) {
  const std::string toml = "a = 1\n\n" + times(40000, "b.") + "c = 2\n";
  EXPECT_EQ(check_excess(toml_excess(toml), toml, "s.toml").error().to_string(),
            "s.toml:3: keys and tables are nested more than 256 deep");
  const std::string xml = "<a>\n<b>\n" + times(300, "<c>\n");
  EXPECT_THAT(check_excess(xml_excess(xml), xml, "m.xml").error().to_string(),
              HasSubstr("m.xml:201: elements are nested more than 200 deep"));
  EXPECT_TRUE(check_excess(toml_excess("a.b = 1"), "a.b = 1", "s.toml").ok());
}

}  // namespace
}  // namespace gloam
