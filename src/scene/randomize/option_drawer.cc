#include "scene/randomize/option_drawer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gloam {

std::optional<std::string> Drawer::draw_override() {
  Dice dice = dice_for(o_.option);
  if (o_.operation != "set")
    return fail("an override cannot be added to or scaled", "use operation = \"set\"");
  if (!o_.choice.empty()) return o_.choice[choose(o_, &dice)].text;
  std::optional<Numbers> low = parse<double>(0), high = parse<double>(1);
  if (!low || !high) return std::nullopt;
  if (!check_override_shape(*low, *high)) return std::nullopt;
  const size_t n = std::max(low->size(), high->size());
  Numbers v;
  for (size_t i = 0; i < n; ++i) v.push_back(one(*low, *high, i, &dice));
  return n == 1 ? text_of(v, 0.0) : text_of(v, Vec3{});
}

Dice Drawer::dice_for(const std::string& path) {
  return Dice(seed_, fmt::format("randomize {} {}", path, (*times_)[path]++));
}

double Drawer::one(const Numbers& a, const Numbers& b, size_t i, Dice* dice) const {
  const double x = a[a.size() == 1 ? 0 : i], y = b[b.size() == 1 ? 0 : i];
  switch (distribution_of(o_).kind) {
    case Distribution::kLogUniform:
      return std::exp(dice->uniform(std::log(x), std::log(y)));
    case Distribution::kNormal:
      return x + y * gaussian(dice);
    default:
      return dice->uniform(x, y);
  }
}

Numbers Drawer::changed(Numbers v, const Numbers& written) const {
  for (size_t i = 0; i < v.size(); ++i) {
    if (o_.operation == "add") v[i] += written[i];
    if (o_.operation == "scale") v[i] *= written[i];
  }
  return v;
}

double Drawer::kept(double x, const FieldRule& rule) {
  const double low = rule.open ? std::nextafter(rule.min, INFINITY) : rule.min;
  const double high = rule.open ? std::nextafter(rule.max, -INFINITY) : rule.max;
  return std::clamp(x, low, high);
}

}  // namespace gloam
