#pragma once
// Operators and constants of expressions.

#include <cmath>
#include <string_view>

namespace gloam::expression {

/// Truth of an operation on what is not NaN; NaN else.
template <class Operation>
inline double truth(double a, double b, Operation operation) {
  return std::isnan(a) || std::isnan(b) ? NAN : operation(a, b) ? 1.0 : 0.0;
}
inline double add(double a, double b) { return a + b; }
inline double subtract(double a, double b) { return a - b; }
inline double multiply_numbers(double a, double b) { return a * b; }
inline double divide(double a, double b) { return a / b; }
inline double negate(double a) { return -a; }
inline double is_untrue(double a) { return std::isnan(a) ? NAN : a == 0 ? 1.0 : 0.0; }
inline double is_either(double a, double b) {
  return truth(a, b, [](double x, double y) { return x != 0 || y != 0; });
}
inline double is_both(double a, double b) {
  return truth(a, b, [](double x, double y) { return x != 0 && y != 0; });
}

struct Comparison {
  std::string_view sign;
  double (*call)(double, double);
};
inline constexpr Comparison kComparisons[] = {
    {"<", [](double a, double b) { return truth(a, b, [](double x, double y) { return x < y; }); }},
    {"<=",
     [](double a, double b) { return truth(a, b, [](double x, double y) { return x <= y; }); }},
    {">", [](double a, double b) { return truth(a, b, [](double x, double y) { return x > y; }); }},
    {">=",
     [](double a, double b) { return truth(a, b, [](double x, double y) { return x >= y; }); }},
    {"==",
     [](double a, double b) { return truth(a, b, [](double x, double y) { return x == y; }); }},
    {"!=",
     [](double a, double b) { return truth(a, b, [](double x, double y) { return x != y; }); }}};

struct NamedConstant {
  std::string_view name;
  double value;
};
inline constexpr NamedConstant kConstants[] = {{"pi", M_PI}, {"true", 1}, {"false", 0}};

}  // namespace gloam::expression
