#pragma once
// Functions of expressions: a function is a row of this table.

#include <cmath>
#include <string_view>

#include "metrics/expression.h"

namespace gloam {

/// Way in which a function's arguments become one value.
enum class FunctionKind : uint8_t {
  kOne,       ///< call1 of a number
  kFold,      ///< call2 of the first two numbers, of that and the third …
  kNorm,      ///< length of a vector
  kDot,       ///< of two vectors
  kCross,     ///< of two vectors
  kDistance,  ///< between two points
  kVector,    ///< of three numbers
  kClamp,     ///< a number, its least, its most
  kIf,        ///< a condition, a value if it is true, and else
};

struct ExpressionFunction {
  std::string_view name;
  FunctionKind kind;
  int least, most;  ///< arguments
  double (*call1)(double) = nullptr;
  double (*call2)(double, double) = nullptr;
};

/// NaN if one of both is, unlike std::fmin.
inline double least_of(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? NAN : std::fmin(a, b);
}
inline double most_of(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? NAN : std::fmax(a, b);
}
/// As fmod, but with the sign of b: angles wrap into 0 … b.
inline double floored_mod(double a, double b) { return a - b * std::floor(a / b); }

inline constexpr int kMostArguments = 16;
inline constexpr ExpressionFunction kExpressionFunctions[] = {
    {"abs", FunctionKind::kOne, 1, 1, [](double x) { return std::fabs(x); }},
    {"sqrt", FunctionKind::kOne, 1, 1, [](double x) { return std::sqrt(x); }},
    {"exp", FunctionKind::kOne, 1, 1, [](double x) { return std::exp(x); }},
    {"log", FunctionKind::kOne, 1, 1, [](double x) { return std::log(x); }},
    {"sin", FunctionKind::kOne, 1, 1, [](double x) { return std::sin(x); }},
    {"cos", FunctionKind::kOne, 1, 1, [](double x) { return std::cos(x); }},
    {"tan", FunctionKind::kOne, 1, 1, [](double x) { return std::tan(x); }},
    {"asin", FunctionKind::kOne, 1, 1, [](double x) { return std::asin(x); }},
    {"acos", FunctionKind::kOne, 1, 1, [](double x) { return std::acos(x); }},
    {"atan", FunctionKind::kOne, 1, 1, [](double x) { return std::atan(x); }},
    {"floor", FunctionKind::kOne, 1, 1, [](double x) { return std::floor(x); }},
    {"ceil", FunctionKind::kOne, 1, 1, [](double x) { return std::ceil(x); }},
    {"round", FunctionKind::kOne, 1, 1, [](double x) { return std::round(x); }},
    {"sign", FunctionKind::kOne, 1, 1, [](double x) { return x > 0   ? 1.0
                                                             : x < 0 ? -1.0
                                                                     : x; }},
    {"deg", FunctionKind::kOne, 1, 1, [](double x) { return x * (180 / M_PI); }},
    {"rad", FunctionKind::kOne, 1, 1, [](double x) { return x * (M_PI / 180); }},
    {"min", FunctionKind::kFold, 2, kMostArguments, nullptr, least_of},
    {"max", FunctionKind::kFold, 2, kMostArguments, nullptr, most_of},
    {"hypot", FunctionKind::kFold, 2, 3, nullptr,
     [](double a, double b) { return std::hypot(a, b); }},
    {"atan2", FunctionKind::kFold, 2, 2, nullptr,
     [](double a, double b) { return std::atan2(a, b); }},
    {"mod", FunctionKind::kFold, 2, 2, nullptr, floored_mod},
    {"norm", FunctionKind::kNorm, 1, 1},
    {"dot", FunctionKind::kDot, 2, 2},
    {"cross", FunctionKind::kCross, 2, 2},
    {"distance", FunctionKind::kDistance, 2, 2},
    {"vec", FunctionKind::kVector, 3, 3},
    {"clamp", FunctionKind::kClamp, 3, 3},
    {"if", FunctionKind::kIf, 3, 3},
};

}  // namespace gloam
