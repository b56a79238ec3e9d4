#include "render/axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tumble::render {

double round_number_below(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  const double lead = value / decade * (1 + 1e-12);
  return decade * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

std::vector<Tick> ticks(double low, double high, int count) {
  std::vector<Tick> marks;
  if (!(high > low) || count < 1) return marks;
  // The round step that comes nearest to the wanted number.
  const double wanted = (high - low) / count;
  double step = round_number_below(wanted);
  for (const double other : {2 * step, 2.5 * step, 5 * step}) {
    const double next = round_number_below(other);
    if (std::abs(std::log(next / wanted)) < std::abs(std::log(step / wanted))) step = next;
  }
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  const auto first = static_cast<long long>(std::ceil(low / step - 1e-9));
  for (long long i = first; static_cast<double>(i) * step <= high + 1e-9 * step; ++i) {
    const double value = static_cast<double>(i) * step;
    const std::string size = fmt::format("{:.{}f}", std::abs(value), decimals);
    marks.push_back({value, value < 0 ? "−" + size : size});
  }
  return marks;
}

}  // namespace tumble::render
