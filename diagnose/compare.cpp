#include "diagnose/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "core/angle.h"
#include "core/motion_quantities.h"
#include "core/quantile.h"
#include "diagnose/chance.h"
#include "diagnose/sampled.h"

namespace tumble::diagnose {
namespace {

constexpr double kOneInHundred = 2.326;  // normal deviate that one in a hundred exceeds
constexpr double kSameMill = 0.02;       // of the diameter, of speed and filling

// Quantities of one kin hardly know more than one of them does.
std::string kin_of(const std::string& name) {
  for (const char* kin : {"toe_", "shoulder_", "torque_"})
    if (name.starts_with(kin)) return kin;
  return name;
}

bool is_condition(const std::string& name) {
  return name == "speed_rpm" || name == "speed_fraction" || name == "filling";
}

// What is seen of these hangs on how far balls go from picture to picture: a run knows velocities at an instant, a film
// means over pictures, which impacts and chance collisions drop out of.
bool hangs_on_rate(const std::string& name) { return name == "granular_temperature_m2_s2" || name == "flight_share"; }

bool has_length(const MotionQuantity& q) { return std::strpbrk(q.unit, "mNs") != nullptr && !q.is_direction; }

double share_apart(double a, double b) { return std::abs(b - a) / (0.5 * (std::abs(a) + std::abs(b))); }

std::vector<Difference> compare_quantities(const ChargeMotion& a, const ChargeMotion& b, bool lengths) {
  const Freedoms freedoms{batch_freedom(a.frames), batch_freedom(b.frames)};
  std::vector<Difference> all;
  std::vector<double> chances;
  for (const MotionQuantity& q : kMotionQuantities) {
    Difference d{.name = q.name, .unit = q.unit_in_words, .a = a.*q.of, .b = b.*q.of};
    const bool no_a = std::isnan(d.a.value), no_b = std::isnan(d.b.value);
    if (no_a && no_b) continue;
    d.is_condition = is_condition(d.name);
    const bool bound =
        hangs_on_rate(d.name) && (a.source == MotionSource::kRunFile) != (b.source == MotionSource::kRunFile);
    d.counts = !d.is_condition && !bound;
    double chance = kNotGiven;
    if (no_a || no_b) {
      d.note = no_a ? "only B has it" : "only A has it";
    } else if (!lengths && has_length(q) && !d.is_condition) {
      d.note = "not compared: mills of different size";
    } else {
      d.difference = q.is_direction ? wrap_180(d.b.value - d.a.value) : d.b.value - d.a.value;
      d.se = std::hypot(d.a.se, d.b.se);
      if (d.se > 0) {
        d.z = d.difference / d.se;
        d.chance = two_sided_chance(normal_z(d.z, welch_freedom(d.a.se, d.b.se, freedoms)));
        if (d.counts) chance = d.chance;
        if (bound) d.note = "hangs on the pictures' rate: does not count";
      } else if (!d.is_condition) {
        d.note = "no standard error";
      }
    }
    all.push_back(d);
    chances.push_back(chance);
  }
  const std::vector<char> named = beyond_chance(chances, kFalseAlarms);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].significant = named[i] != 0;
  return all;
}

Agreement agreement_of(const std::vector<Difference>& differences, const Freedoms& freedoms) {
  Agreement of{.name = "quantities"};
  std::set<std::string> kins;
  double squares = 0;
  for (const Difference& d : differences) {
    if (!d.counts || std::isnan(d.z)) continue;
    squares += std::pow(normal_z(d.z, welch_freedom(d.a.se, d.b.se, freedoms)), 2);
    ++of.compared;
    kins.insert(kin_of(d.name));
  }
  of.independent = 0.5 * static_cast<double>(kins.size());
  if (of.compared > 0) of.mean_square = squares / of.compared;
  return of;
}

Agreement agreement_of(const std::string& name, double independent, const std::vector<SampledDifference>& among,
                       std::initializer_list<const char*> names) {
  Agreement of{.name = name, .independent = independent};
  double squares = 0;
  for (const SampledDifference& d : among) {
    if (std::none_of(names.begin(), names.end(), [&](const char* one) { return d.name == one; })) continue;
    of.compared += d.compared;
    if (d.compared > 0) squares += d.mean_square * d.compared;
  }
  of.independent = std::min(of.independent, static_cast<double>(of.compared));
  if (of.compared > 0) of.mean_square = squares / of.compared;
  return of;
}

void sum_up(Deviation& d, const Freedoms& freedoms) {
  d.agreements.push_back(agreement_of(d.differences, freedoms));
  // A thousand cells scatter like ten numbers, for the charge heaves as a whole; and so do the other kinds. How many,
  // is taken from pairs of runs that differ in their seed alone (docs/compare.md).
  d.agreements.push_back(agreement_of("occupancy", 6, d.fields, {"occupancy"}));
  d.agreements.push_back(agreement_of("velocity", 12, d.fields, {"velocity_x", "velocity_y"}));
  std::erase_if(d.agreements, [](const Agreement& of) { return of.compared == 0; });
  double mean = 0, variance = 0;
  const double kinds = static_cast<double>(d.agreements.size());
  if (kinds == 0) return;
  for (const Agreement& of : d.agreements) {
    mean += of.mean_square / kinds;
    variance += 2 / of.independent / (kinds * kinds);
  }
  d.chi = std::sqrt(mean);
  // Like chi-squared of f degrees of freedom over f: Wilson and Hilferty (1931).
  const double f = 2 / variance;
  const auto share_below = [&](double z) { return std::pow(1 - 2 / (9 * f) + z * std::sqrt(2 / (9 * f)), 1.5); };
  d.chi_limit = share_below(kOneInHundred);
  if (d.chi < share_below(-kOneInHundred))
    d.caveats.push_back(
        "The number is far below 1: A and B may show the same motion, whose chances they then share, and small "
        "differences are known better than their errors say.");
}

std::string percent_apart(double a, double b) { return fmt::format("{:.2g} %", 100 * share_apart(a, b)); }

// What one cell in ten moves faster than [m/s]; 0 where no velocity is known.
double fast(const Field& field) {
  std::vector<double> speeds;
  for (std::size_t k = 0; k < field.vx.size(); ++k)
    if (field.occupancy[k] > 0.02 && !std::isnan(field.vx[k])) speeds.push_back(std::hypot(field.vx[k], field.vy[k]));
  return speeds.empty() ? 0 : quantile_of(std::move(speeds), 0.9);
}

// A film that is too slow for its balls tells so by the other source, for its own velocities are those of slow balls.
void note_slow_film(Deviation& d, const ChargeMotion& m, const ChargeMotion& other, const char* name) {
  if (m.source == MotionSource::kRunFile || m.tracks.empty()) return;
  std::vector<double> radii;
  for (const TrackPoint& p : m.tracks.read(0, std::min<std::size_t>(m.tracks.size(), 2000)))
    if (!std::isnan(p.radius)) radii.push_back(p.radius);
  if (radii.empty()) return;
  const double far =
      std::max(fast(m.field), fast(other.field)) / m.frames_per_second / (2 * median_of(std::move(radii)));
  if (far > 0.9)
    d.caveats.push_back(fmt::format(
        "{}: the faster balls go {:.1f} of their diameters from picture to picture, too far to be followed well. "
        "Velocities, circulation and flights lean towards slow balls; more pictures a second are needed.",
        name, far));
}

void note_conditions(Deviation& d, const ChargeMotion& a, const ChargeMotion& b, bool same_size) {
  const auto add = [&](const std::string& text) { d.caveats.push_back(text); };
  if (!same_size)
    add(
        fmt::format("The mills differ in diameter ({:.4g} m and {:.4g} m): only what has no length in it is compared, "
                    "angles, shares and occupancy in units of the mill's radius.",
                    2 * a.mill_radius, 2 * b.mill_radius));
  else if (std::isnan(a.mill_radius) || std::isnan(b.mill_radius))
    add("The diameter of one mill is not known: lengths and velocities may not compare; give --mill.");
  if (a.lifter_count > 0 && b.lifter_count > 0 && a.lifter_count != b.lifter_count)
    add(fmt::format("The mills have {} and {} lifters: differences are of different mills, not of a model.",
                    a.lifter_count, b.lifter_count));
  // One sentence for speed: as a share of critical where both have it.
  const bool shares = std::isfinite(a.speed_fraction.value + b.speed_fraction.value);
  const Estimate &sa = shares ? a.speed_fraction : a.speed_rpm, &sb = shares ? b.speed_fraction : b.speed_rpm;
  if (share_apart(sa.value, sb.value) > kSameMill)
    add(
        fmt::format("The mills turned at different speeds ({:.4g} and {:.4g} {}, {} apart): differences are to be "
                    "expected.",
                    sa.value, sb.value, shares ? "of critical" : "rev/min", percent_apart(sa.value, sb.value)));
  const double apart = std::abs(b.filling.value - a.filling.value), se = std::hypot(a.filling.se, b.filling.se);
  if (share_apart(a.filling.value, b.filling.value) > kSameMill && !(apart < 2 * se))
    add(fmt::format("The mills were filled differently ({:.3g} and {:.3g}, {} apart): differences are to be expected.",
                    a.filling.value, b.filling.value, percent_apart(a.filling.value, b.filling.value)));
  if (a.field.n > 0 && b.field.n > 0 && a.field.n != b.field.n)
    add(fmt::format("The fields have different grids ({0} x {0} and {1} x {1} cells) and are not compared.", a.field.n,
                    b.field.n));
}

// "9.4 degrees", "0.012 m", with the digits that the error gives meaning to.
std::string amount(double value, double se, const std::string& unit) {
  const int decimals = se > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(se))), 0, 6) : 3;
  const std::string digits = fmt::format("{:.{}f}", std::abs(value), unit == "deg" ? std::min(decimals, 1) : decimals);
  return unit == "deg" ? digits + "°" : unit.empty() ? digits : digits + " " + unit;
}

std::string lower_first(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

// The most certain differences first, one of each kin.
std::string quantities_in_words(const std::vector<Difference>& differences) {
  std::vector<const Difference*> named;
  for (const Difference& d : differences)
    if (d.significant) named.push_back(&d);
  std::sort(named.begin(), named.end(),
            [](const Difference* p, const Difference* q) { return std::abs(p->z) > std::abs(q->z); });
  std::set<std::string> said;
  std::string text;
  for (const Difference* d : named) {
    if (said.size() == 3 || !said.insert(kin_of(d->name)).second) continue;
    text +=
        fmt::format("{}{} {}{} ({:.1f} sigma)", text.empty() ? "B against A: " : ", ", lower_first(words_for(d->name)),
                    d->difference > 0 ? "+" : "\u2212", amount(d->difference, d->se, d->unit), std::abs(d->z));
  }
  return text;
}

void conclude(Deviation& d) {
  // Lines have no vote: ring, surface and profile are cuts through the fields, and the bands of spectra scatter more
  // than their errors say (bursts; in films, the noise of single pictures).
  int fields = 0;
  for (const SampledDifference& f : d.fields) fields += f.beyond_chance;
  const std::string quantities = quantities_in_words(d.differences);
  const bool differ = !quantities.empty() || fields > 0 || d.chi > d.chi_limit;
  d.verdict = differ ? Verdict::kDiffer : Verdict::kAgree;
  const std::string number = fmt::format(
      "Over all, differences are {:.2f} times what chance makes them (equal mills: 1, and less than {:.2f}).", d.chi,
      d.chi_limit);
  if (!differ) {
    d.sentence = "They agree. Nothing differs by more than chance makes it. " + number;
    return;
  }
  std::string text = quantities;
  for (const SampledDifference& f : d.fields) {
    if (f.beyond_chance == 0 || (f.name == "velocity_y" && d.fields[1].beyond_chance >= f.beyond_chance) ||
        (f.name == "velocity_x" && d.fields[2].beyond_chance > f.beyond_chance))
      continue;
    text += fmt::format("{}{} differs in {} of {} cells, most {}", text.empty() ? "The " : "; the ",
                        f.name == "occupancy" ? "occupancy" : "velocity", f.beyond_chance, f.compared, f.where);
  }
  if (text.empty()) text = "No single quantity does so beyond chance, but all of them together do";
  d.sentence = "They differ. " + text + ". " + number;
}

}  // namespace

Deviation compare(const ChargeMotion& a, const ChargeMotion& b) {
  Deviation d;
  d.a = a.origin;
  d.b = b.origin;
  const bool same_size = !(share_apart(a.mill_radius, b.mill_radius) > kSameMill);
  d.differences = compare_quantities(a, b, same_size);
  d.fields = compare_fields(a, b, same_size);
  d.lines = compare_lines(a, b, same_size);
  if (same_size)
    for (const auto& compare_over_time : {compare_lifter_passages, compare_spectra})
      for (SampledDifference& line : compare_over_time(a, b)) d.lines.push_back(std::move(line));
  note_conditions(d, a, b, same_size);
  if (same_size) note_slow_film(d, a, b, "A");
  if (same_size) note_slow_film(d, b, a, "B");
  sum_up(d, {batch_freedom(a.frames), batch_freedom(b.frames)});
  if (!std::isnan(d.chi))
    conclude(d);
  else
    d.sentence = "Nothing that both have comes with a standard error, so it cannot be said whether they agree.";
  return d;
}

}  // namespace tumble::diagnose
