#include "cli/vary.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "io/sweep_file.h"

namespace tumble::cli {
namespace {

constexpr double kMostValues = 1e5;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// At commas outside of brackets and quotes: a list of ball classes is one value.
std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  int depth = 0;
  char quote = 0;
  for (const char c : text) {
    if (quote)
      quote = c == quote ? '\0' : quote;
    else if (c == '"' || c == '\'')
      quote = c;
    else if (c == '[' || c == '{')
      ++depth;
    else if (c == ']' || c == '}')
      --depth;
    if (c == at && depth == 0 && !quote)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  for (std::string& part : parts) part = trimmed(part);
  return parts;
}

void split_key(const std::string& text, const std::string& option, const std::string& example, std::string& key,
               std::string& value) {
  const auto equals = text.find('=');
  key = trimmed(text.substr(0, equals));
  value = equals == std::string::npos ? "" : trimmed(text.substr(equals + 1));
  if (key.empty() || value.empty())
    throw InputError(option, "found \"" + text + "\", must be KEY=VALUES such as " + example);
}

// 0.6 + 3 * 0.05 is 0.75, not 0.7500000000000001.
std::string short_number(double x) { return fmt::format("{:.12g}", x == 0 ? 0.0 : x); }

std::vector<std::string> range(const std::string& place, const std::vector<std::string>& parts,
                               std::vector<std::string>& notes) {
  const double from = io::number_of(parts[0]), to = io::number_of(parts[1]), step = io::number_of(parts[2]);
  if (!std::isfinite(from) || !std::isfinite(to) || !std::isfinite(step))
    throw InputError(place, "must be numbers FROM:TO:STEP such as 0.6:1.0:0.05");
  if (!(std::abs(step) > 0) || (to - from) / step < 0)
    throw InputError(place, fmt::format("a step of {} does not lead from {} to {}", parts[2], parts[0], parts[1]));
  const double steps = (to - from) / step;
  if (steps > kMostValues) throw InputError(place, fmt::format("is {:.3g} values; give at most 100000", steps + 1));
  const auto whole = static_cast<std::size_t>(std::floor(steps + 1e-6));
  std::vector<std::string> values;
  for (std::size_t i = 0; i <= whole; ++i) values.push_back(short_number(from + double(i) * step));
  if (steps - double(whole) > 1e-6) {
    values.push_back(short_number(to));
    notes.push_back(fmt::format("{}: the last step, to {}, is shorter", place, values.back()));
  } else {
    values.back() = short_number(to);
  }
  return values;
}

}  // namespace

VariedKey parse_vary(const std::string& text, std::vector<std::string>& notes) {
  VariedKey varied;
  std::string list;
  split_key(text, "--vary", "mill.speed=0.6:1.0:0.05 or mill.speed=0.6,0.7,0.9", varied.key, list);
  const std::string place = "--vary: " + varied.key;
  varied.values = split(list, ':');
  if (varied.values.size() == 3)
    varied.values = range(place, varied.values, notes);
  else if (varied.values.size() != 1)
    throw InputError(place, "found \"" + list + "\", must be FROM:TO:STEP such as 0.6:1.0:0.05, or a list A,B,C");
  else
    varied.values = split(list, ',');
  for (std::size_t i = 0; i < varied.values.size(); ++i) {
    if (varied.values[i].empty()) throw InputError(place, "has an empty value in \"" + list + "\"");
    const double number = io::number_of(varied.values[i]);
    for (std::size_t j = 0; j < i; ++j)
      if (varied.values[i] == varied.values[j] || number == io::number_of(varied.values[j]))
        throw InputError(place, "has the value " + varied.values[i] + " twice");
  }
  return varied;
}

FitRange parse_fit(const std::string& text) {
  FitRange fit;
  std::string range;
  split_key(text, "--fit", "contact.friction=0.05:0.6", fit.key, range);
  const auto ends = split(range, ':');
  const std::string place = "--fit: " + fit.key;
  if (ends.size() == 2) fit.low = io::number_of(ends[0]), fit.high = io::number_of(ends[1]);
  if (ends.size() != 2 || !std::isfinite(fit.low) || !std::isfinite(fit.high) || !(fit.low < fit.high))
    throw InputError(place, "found \"" + range + "\", must be the range LOW:HIGH to look in, such as 0.05:0.6");
  return fit;
}

}  // namespace tumble::cli
