#include "metrics/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace gloam {
namespace {

using Op = Instruction::Op;

void cross(const double* a, const double* b, double* out) {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

// The end of the stack after an instruction that is not a push.
double* operate(const Instruction& in, double* top) {
  const int n = in.width;
  switch (in.op) {
    case Op::kCall1:
      for (int i = 1; i <= n; ++i) top[-i] = in.call1(top[-i]);
      return top;
    case Op::kCall2:
      for (int i = 0; i < n; ++i) top[i - 2 * n] = in.call2(top[i - 2 * n], top[i - n]);
      return top - n;
    case Op::kScale:
      for (int i = 2; i <= 4; ++i) top[-i] *= top[-1];
      return top - 1;
    case Op::kScaleLeft: {
      const double factor = top[-4];
      for (int i = 0; i < 3; ++i) top[i - 4] = factor * top[i - 3];
      return top - 1;
    }
    case Op::kDivide:
      for (int i = 2; i <= 4; ++i) top[-i] /= top[-1];
      return top - 1;
    case Op::kNorm:
      top[-3] = std::sqrt(top[-3] * top[-3] + top[-2] * top[-2] + top[-1] * top[-1]);
      return top - 2;
    case Op::kDot:
      top[-6] = top[-6] * top[-3] + top[-5] * top[-2] + top[-4] * top[-1];
      return top - 5;
    case Op::kCross: {
      double out[3];
      cross(top - 6, top - 3, out);
      std::copy_n(out, 3, top - 6);
      return top - 3;
    }
    case Op::kClamp: {
      const double x = top[-3], low = top[-2], high = top[-1];
      if (!std::isnan(x))
        top[-3] = std::isnan(low) || std::isnan(high) ? NAN : std::fmin(std::fmax(x, low), high);
      return top - 2;
    }
    case Op::kSelect: {
      double* condition = top - 2 * n - 1;
      const double truth = *condition;
      for (int i = 0; i < n; ++i)
        condition[i] = std::isnan(truth) ? NAN : truth != 0 ? condition[1 + i] : top[i - n];
      return condition + n;
    }
    case Op::kPick:
      top[-3] = top[in.first - 3];
      return top - 2;
    case Op::kNumber:
    case Op::kLoad:
      break;
  }
  GLOAM_CHECK(false, "an instruction that pushes is not operated");
  return top;
}

}  // namespace

double Expression::evaluate(std::span<const double> inputs) {
  double* top = stack_.data();
  for (const Instruction& in : program_) {
    if (in.op == Op::kNumber) {
      *top++ = in.number;
    } else if (in.op == Op::kLoad) {
      for (int i = 0; i < in.width; ++i) *top++ = inputs[static_cast<size_t>(in.first + i)];
    } else {
      top = operate(in, top);
    }
  }
  return stack_[0];
}

std::string place_in_expression(const SourceLoc& loc, std::string_view text) {
  if (text.find('\n') == std::string_view::npos) return fmt::format("column {}", loc.column);
  return fmt::format("line {}, column {}", loc.line, loc.column);
}

}  // namespace gloam
