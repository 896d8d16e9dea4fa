// Expressions against the same in C++, and what is refused, with its place.
#include "metrics/expression.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gloam {
namespace {

// "t" = 2, "gap" = NaN, "p" = (1, -2, 2), "q" = (0, 3, 4).
class FewNames final : public QuantityNames {
 public:
  Result<QuantitySlot> find(std::span<const NameStep> name) override {
    last.assign(name.begin(), name.end());
    const std::string& word = name[0].word;
    if (word == "t") return QuantitySlot{0, 1};
    if (word == "gap") return QuantitySlot{7, 1};
    if (word != "p" && word != "q" && word != "body")
      return Error{ErrorKind::kInput, "no '" + word + "'", name[0].loc};
    const int first = word == "q" ? 4 : 1;
    if (name.size() == 1 || word == "body") return QuantitySlot{first, 3};
    return QuantitySlot{first + name[1].word[0] - 'x', 1};
  }
  std::vector<std::string> words() const override { return {"t", "p", "q", "gap", "body"}; }
  std::vector<NameStep> last;
};

const std::vector<double> kInputs = {2, 1, -2, 2, 0, 3, 4, NAN};

double value_of(std::string_view text) {
  FewNames names;
  auto expression = Expression::parse(text, names);
  if (!expression.ok()) {
    ADD_FAILURE() << text << ": " << expression.error().to_string();
    return NAN;
  }
  const double value = expression->evaluate(kInputs);
  const double again = expression->evaluate(kInputs);
  EXPECT_TRUE(value == again || std::isnan(value)) << "an evaluation leaves nothing behind";
  return value;
}

Error error_of(std::string_view text) {
  FewNames names;
  auto expression = Expression::parse(text, names);
  if (!expression.ok()) return expression.error();
  ADD_FAILURE() << "'" << text << "' parses";
  return {ErrorKind::kInput, ""};
}

TEST(Expression, ArithmeticBindsAsInMathematics) {
  EXPECT_EQ(value_of("1 + 2 * 3 - 4 / 8"), 6.5);
  EXPECT_EQ(value_of("(1 + 2) * 3"), 9);
  EXPECT_EQ(value_of("10 - 4 - 3"), 3);
  EXPECT_EQ(value_of("64 / 4 / 2"), 8);
  EXPECT_EQ(value_of("2 ^ 3 ^ 2"), 512) << "from the right";
  EXPECT_EQ(value_of("-2 ^ 2"), -4);
  EXPECT_EQ(value_of("2 ^ -1"), 0.5);
  EXPECT_EQ(value_of("- - 3"), 3);
  EXPECT_EQ(value_of("1.5e3 + .5"), 1500.5);
  EXPECT_EQ(value_of(" \t1\n+ 1 "), 2);
}

TEST(Expression, ConditionsAreOneAndZero) {
  EXPECT_EQ(value_of("1 < 2"), 1);
  EXPECT_EQ(value_of("2 <= 1"), 0);
  EXPECT_EQ(value_of("2 == 2 and 1 != 2"), 1);
  EXPECT_EQ(value_of("1 > 2 or not 1 > 2"), 1);
  EXPECT_EQ(value_of("true or false and false"), 1) << "'and' binds before 'or'";
  EXPECT_EQ(value_of("t > 1 ? 10 : 20"), 10);
  EXPECT_EQ(value_of("t > 3 ? 10 : t > 1 ? 20 : 30"), 20);
  EXPECT_EQ(value_of("if(t < 1, 10, 20)"), 20);
}

TEST(Expression, FunctionsAreThoseOfTheLibrary) {
  EXPECT_EQ(value_of("abs(-3) + sqrt(16) + floor(1.7) + ceil(1.2) + round(1.5) + sign(-2)"), 11);
  EXPECT_EQ(value_of("min(3, 1, 2) + max(3, 7, 2)"), 8);
  EXPECT_EQ(value_of("hypot(3, 4) + hypot(2, 3, 6)"), 12);
  EXPECT_NEAR(value_of("atan2(1, -1)"), 0.75 * M_PI, 1e-15);
  EXPECT_EQ(value_of("clamp(5, 0, 3) + clamp(-5, 0, 3)"), 3);
  EXPECT_NEAR(value_of("sin(pi / 6) + cos(0) + exp(log(2))"), 3.5, 1e-15);
  EXPECT_NEAR(value_of("deg(pi) + rad(180) - pi"), 180, 1e-12);
  EXPECT_EQ(value_of("mod(-1, 4)"), 3);
}

TEST(Expression, VectorsHaveThreeNumbers) {
  EXPECT_EQ(value_of("norm(p)"), 3);
  EXPECT_EQ(value_of("p.y"), -2);
  EXPECT_EQ(value_of("dot(p, q)"), 2);
  EXPECT_EQ(value_of("distance(p, q)"), std::sqrt(1 + 25 + 4));
  EXPECT_EQ(value_of("cross(p, q).x"), -14);
  EXPECT_EQ(value_of("cross(p, q).y"), -4);
  EXPECT_EQ(value_of("cross(p, q).z"), 3);
  EXPECT_EQ(value_of("(2 * p - q / 2 + p * 3).z"), 8);
  EXPECT_EQ(value_of("(-p).x"), -1);
  EXPECT_EQ(value_of("norm(t > 1 ? p : q)"), 3);
  EXPECT_EQ(value_of("norm(if(t > 5, p, q))"), 5);
  EXPECT_EQ(value_of("norm(vec(2, 3, 6))"), 7);
}

TEST(Expression, WhatIsNotANumberStaysSo) {
  for (const char* text : {"gap + 1", "gap < 1", "not gap", "gap and 0", "1 or gap", "min(gap, 1)",
                           "max(1, gap)", "clamp(gap, 0, 1)", "gap ? 1 : 2", "sqrt(-1)", "0 / 0"})
    EXPECT_TRUE(std::isnan(value_of(text))) << text;
  EXPECT_EQ(value_of("t > 1 ? 1 : gap"), 1) << "a choice that is not taken";
}

TEST(Expression, NamesComeInSteps) {
  FewNames names;
  ASSERT_TRUE(Expression::parse("norm(body(\"ada/trunk\", 'b')[2].velocity)", names).ok());
  ASSERT_EQ(names.last.size(), 2u);
  EXPECT_TRUE(names.last[0].is_call);
  EXPECT_EQ(names.last[0].arguments, (std::vector<std::string>{"ada/trunk", "b"}));
  EXPECT_EQ(names.last[0].index, 2);
  EXPECT_EQ(names.last[0].loc.column, 6);
  EXPECT_EQ(names.last[1].word, "velocity");
  EXPECT_FALSE(names.last[1].is_call);
}

struct Refusal {
  const char* text;
  int line, column;
  const char* message;
};

TEST(Expression, RefusalsTellWhere) {
  const Refusal kRefusals[] = {
      {"", 1, 1, "unexpected end"},
      {"1 +", 1, 4, "unexpected end"},
      {"1 + * 2", 1, 5, "unexpected '*'"},
      {"(1 + 2", 1, 7, "unexpected end"},
      {"1 2", 1, 3, "unexpected '2'"},
      {"2t", 1, 1, "neither a number nor a name"},
      {"1e999", 1, 1, "out of range"},
      {"\"t", 1, 1, "unterminated string"},
      {"t && t", 1, 3, "unknown operator '&&'"},
      {"t = 1", 1, 3, "unknown operator '='"},
      {"1 < 2 < 3", 1, 7, "cannot be chained"},
      {"1 +\n  sqr(2)", 2, 3, "unknown function 'sqr'"},
      {"p", 1, 1, "a number, not a vector"},
      {"p + 1", 1, 3, "a number and a vector"},
      {"p * q", 1, 3, "two vectors"},
      {"1 / p", 1, 3, "divide by a vector"},
      {"norm(1)", 1, 6, "a vector"},
      {"sqrt(p)", 1, 6, "a number"},
      {"min(1)", 1, 1, "2 to 16 arguments"},
      {"sqrt()", 1, 1, "1 argument"},
      {"sqrt(1, 2)", 1, 1, "1 argument"},
      {"t > 1 ? p : 1", 1, 9, "the other a vector"},
      {"not p", 1, 5, "a number"},
      {"body(t).x", 1, 6, "quoted names"},
      {"p[-1].x", 1, 3, "whole number"},
      {"p[1.5].x", 1, 3, "whole number"},
      {"p[1e300].x", 1, 3, "whole number"},
      {"(p).w", 1, 5, "unexpected 'w'"},
      {"wrong + 1", 1, 1, "no 'wrong'"},
      {"t \xc3\xa4", 1, 3, "unexpected character"},
      {"t \xff", 1, 3, "unexpected character"},
  };
  for (const auto& [text, line, column, message] : kRefusals) {
    const Error error = error_of(text);
    EXPECT_NE(error.message.find(message), std::string::npos) << text << ": " << error.message;
    EXPECT_EQ(error.loc.line, line) << text;
    EXPECT_EQ(error.loc.column, column) << text;
  }
  EXPECT_NE(error_of("sqr(2)").hint.find("sqrt"), std::string::npos);
}

TEST(Expression, HostileTextIsRefusedEarly) {
  const auto repeat = [](const std::string& what, int times) {
    std::string all;
    for (int i = 0; i < times; ++i) all += what;
    return all;
  };
  EXPECT_NE(error_of(repeat("(", 1000) + "1").message.find("nested"), std::string::npos);
  EXPECT_NE(error_of(repeat("-", 1000) + "1").message.find("nested"), std::string::npos);
  EXPECT_NE(error_of(repeat("not ", 900) + "1").message.find("nested"), std::string::npos);
  EXPECT_NE(error_of(repeat("2^", 1000) + "2").message.find("nested"), std::string::npos);
  EXPECT_NE(error_of(repeat("t?", 1000) + "1").message.find("nested"), std::string::npos);
  EXPECT_NE(error_of(repeat("abs(", 1000) + "1").message.find("nested"), std::string::npos);
  EXPECT_NE(error_of(repeat("1+", 3000) + "1").message.find("4096"), std::string::npos);
  EXPECT_EQ(value_of(repeat("1+", 2000) + "1"), 2001) << "long, and not deep";
}

}  // namespace
}  // namespace gloam
