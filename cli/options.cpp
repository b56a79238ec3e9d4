#include "cli/options.h"

#include <charconv>
#include <cmath>
#include <numeric>
#include <system_error>

#include "core/error.h"

namespace tumble::cli {

void add_common(CLI::App& verb, CommonOptions& options) {
  verb.add_flag("--quiet", options.quiet, "No progress and no remarks on standard error");
  verb.add_flag("--json", options.json, "Print the result's summary as one JSON object on standard output");
  verb.add_flag("--force", options.force, "Replace an output that exists");
  verb.add_option("--threads", options.threads, "Use at most this many threads (default: all)")
      ->check(CLI::Range(1, 1024));
}

void parse_size(const std::string& text, const std::string& option, int& width, int& height) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, width);
  const bool crossed = first.ec == std::errc() && first.ptr != end && *first.ptr == 'x';
  const auto second = crossed ? std::from_chars(first.ptr + 1, end, height) : first;
  if (!crossed || second.ec != std::errc() || second.ptr != end)
    throw InputError(option, "is \"" + text + "\"; give WIDTHxHEIGHT in pixels, such as 1280x720");
  if (width < 160 || height < 120 || width > 7680 || height > 4320 || width % 2 || height % 2)
    throw InputError(option, "is " + text + "; give even numbers from 160x120 to 7680x4320");
}

void parse_point(const std::string& text, const std::string& option, double& u, double& v) {
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, u);
  const bool two = first.ec == std::errc() && first.ptr != end && *first.ptr == ',';
  const auto second = two ? std::from_chars(first.ptr + 1, end, v) : first;
  if (!two || second.ec != std::errc() || second.ptr != end || !std::isfinite(u) || !std::isfinite(v))
    throw InputError(option, "is \"" + text + "\"; give u,v in pixels, such as 640.5,360");
}

void parse_rate(double fps, const std::string& option, int& numerator, int& denominator) {
  if (!(fps >= 1 && fps <= 1000)) throw InputError(option, "must lie between 1 and 1000 frames per second");
  const double ntsc = fps * 1001 / 1000;
  if (std::abs(ntsc - std::round(ntsc)) < 1e-3 && std::abs(fps - std::round(fps)) > 1e-3) {
    numerator = static_cast<int>(std::round(ntsc)) * 1000;
    denominator = 1001;
    return;
  }
  numerator = static_cast<int>(std::round(fps * 1000));
  denominator = 1000;
  const int common = std::gcd(numerator, denominator);
  numerator /= common;
  denominator /= common;
}

}  // namespace tumble::cli
