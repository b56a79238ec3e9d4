#include "io/report/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>

#include "core/error.h"
#include "io/report/embedded.h"

namespace tumble::io::report {
namespace {

constexpr const char* kMinus = "\u2212";
constexpr const char* kNothing = "\u2013";

std::string valid_utf8(const std::string& text) {
  return Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

// A hyphen is not a minus, and nothing has no sign.
std::string typeset(std::string digits) {
  if (digits.find_first_of("123456789") == std::string::npos && digits.starts_with('-')) digits.erase(0, 1);
  if (!digits.empty() && digits[0] == '-') digits.replace(0, 1, kMinus);
  return digits;
}

int decimals_for(double se) { return std::clamp(1 - static_cast<int>(std::floor(std::log10(se))), 0, 9); }

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : valid_utf8(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string script_json(const Json& json) {
  std::string out;
  for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace)) {
    if (c == '<')
      out += "\\u003c";  // only ever inside a string
    else
      out += c;
  }
  return out;
}

std::string head_html(const std::string& title, const std::string& media) {
  return filled(head_html_page, {{"title", escaped(title)},
                                 {"media", media},
                                 {"page_js", std::string(page_js)},
                                 {"uplot_css", std::string(uplot_css)},
                                 {"style", std::string(style_css)}});
}

std::string caveats_html(const std::vector<std::string>& caveats) {
  if (caveats.empty()) return "";
  std::string items;
  for (const auto& text : caveats) items += "<li>" + escaped(text) + "</li>";
  return R"(<section class="caveats"><h2>Before you believe the numbers</h2><ul>)" + items + "</ul></section>";
}

std::string footer_html(const std::string& version) {
  return "Written by tumble " + escaped(version) + ". This page needs no other file and no network.";
}

std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < n ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kDigits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return out;
}

std::string video_html_of(const std::string& url, const std::string& attributes) {
  return "<video " + attributes + " preload=\"auto\" src=\"" + escaped(url) + "\"></video>";
}

std::string video_html(const std::filesystem::path& file, const std::string& attributes) {
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw WorkError(file.string(), std::string("cannot be read for the report: ") + std::strerror(errno));
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  return video_html_of("data:video/mp4;base64," + base64(bytes), attributes);
}

std::string filled(std::string_view page, const std::map<std::string, std::string>& values) {
  std::string out;
  std::set<std::string> used;
  for (std::size_t at = 0;;) {
    const std::size_t open = page.find("{{", at);
    out += page.substr(at, open - at);
    if (open == std::string_view::npos) break;
    const std::size_t close = page.find("}}", open);
    if (close == std::string_view::npos) throw std::logic_error("the page has a place that does not end");
    const std::string name(page.substr(open + 2, close - open - 2));
    const auto value = values.find(name);
    if (value == values.end()) throw std::logic_error("the page's place " + name + " has no value");
    out += value->second;
    used.insert(name);
    at = close + 2;
  }
  for (const auto& [name, value] : values)
    if (!used.contains(name)) throw std::logic_error("the page has no place for " + name);
  return out;
}

std::string number(double value, double se) {
  if (!std::isfinite(value)) return kNothing;
  if (se > 0 && std::isfinite(se)) return typeset(fmt::format("{:.{}f}", value, decimals_for(se)));
  return typeset(fmt::format("{:.4g}", value));
}

std::string with_error(const Estimate& e) {
  if (!std::isfinite(e.value) || !(e.se > 0) || !std::isfinite(e.se)) return number(e.value);
  return number(e.value, e.se) + "\u00a0\u00b1\u00a0" + number(e.se, e.se);
}

}  // namespace tumble::io::report
