#include "diagnose/exact_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnose/check_parts.h"
#include "diagnose/suspects.h"

namespace tumble::diagnose {
namespace {

constexpr double kQuiet = 2;      // standard errors within which nothing shows
constexpr double kWouldShow = 5;  // as many standard errors a suspect at full strength must reach to be ruled out

}  // namespace

ExactCheck make_check(const Measurement& m, const std::string& name, double found, double expected, double se,
                      const std::string& unit, const std::vector<MovedBy>& moved_by, const Saying& saying, double z) {
  ExactCheck c;
  c.name = name;
  c.experiment = m.experiment.name;
  c.found = found;
  c.expected = expected;
  c.se = se;
  c.z = std::isnan(z) ? (found - expected) / se : z;
  c.unit = unit;
  if (!moved_by.empty()) {
    c.strength = (found - expected) * moved_by.front().per;
    c.strength_se = se * std::abs(moved_by.front().per);
  }
  c.moved_by = moved_by;
  for (const Suspect& s : moved_by.empty() ? std::vector<Suspect>{} : suspects_of(m.config)) {
    const auto by =
        std::find_if(moved_by.begin(), moved_by.end(), [&](const MovedBy& b) { return b.suspect == s.name; });
    const bool moves = by != moved_by.end();
    const bool would_show = moves && s.full > kWouldShow * se * std::abs(by->per);
    if (c.is_clear() ? !moves : std::abs(c.z) < kQuiet && would_show)
      if (std::find(c.excludes.begin(), c.excludes.end(), s.name) == c.excludes.end()) c.excludes.push_back(s.name);
  }
  const std::string space = unit.empty() ? "" : " ";
  c.says = fmt::format("{} {:.5g} +- {:.2g}{}{} where {:.5g}{}{} is expected: {}", saying.what, found, se, space, unit,
                       expected, space, unit, std::abs(c.z) > kQuiet ? saying.odd : saying.usual);
  return c;
}

std::vector<ExactCheck> exact_checks(const Measurement& m) {
  std::vector<ExactCheck> checks;
  check_drum(m, checks);
  if (m.frames.size() >= 3) {
    check_lengths(m, checks);
    check_balls(m, checks);
    check_flights(m, checks);
  }
  check_balance(m, checks);
  return checks;
}

}  // namespace tumble::diagnose
