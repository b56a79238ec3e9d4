#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>

#include "core/suspect_words.h"
#include "io/diagnosis_words.h"
#include "io/report/diagnosis_parts.h"
#include "io/report/section.h"

namespace tumble::io::report {
namespace {

constexpr double kWorthABar = 0.005;  // of a suspect's probability

std::string one_digit(double v) { return std::isnan(v) ? "–" : fmt::format("{:.1f}", v); }
std::string kind_in_words(NameKind kind) {
  switch (kind) {
    case NameKind::kPhysics:
      return "physics of the mill";
    case NameKind::kArtefact:
      return "error of measurement";
    default:
      return "";
  }
}

std::string bar_row(const RankedName& r, bool is_found) {
  const std::string chi = gap_in_words(r.misfit);
  const bool has_strength = std::isfinite(r.strength.value.value) && !r.strength.name.empty();
  return fmt::format(
      "<tr{}><th scope=\"row\">{}<small>{}</small></th><td class=\"probability\"><span class=\"bar\"><i class=\"{}\" "
      "style=\"width:{:.1f}%\"></i></span>"
      "<b>{}</b></td><td>{}</td><td>{}</td></tr>\n",
      is_found ? " class=\"is-found\"" : "", escaped(with_capital(words_of_suspect(r.name))),
      escaped(kind_in_words(r.kind)), name_of(r.kind), 100 * r.probability,
      escaped(probability_in_words(r.probability)), has_strength ? escaped(parameter_in_words(r.strength)) : "", chi);
}

std::string ranking_html(const Diagnosis& d, PageTable& ruled_out) {
  std::string rows;
  int shown = 0;
  for (const RankedName& r : d.ranking) {
    const bool is_found =
        std::any_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& e) { return e.name == r.name; });
    if (is_found || r.probability >= kWorthABar || shown < 2) {
      rows += bar_row(r, is_found);
      ++shown;
    } else {
      ruled_out.rows.push_back({with_capital(words_of_suspect(r.name)), probability_in_words(r.probability),
                                gap_in_words(r.misfit),
                                r.ruled_out_by.empty() ? "others explain the data better" : r.ruled_out_by});
    }
  }
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Ranking\"><table "
         "class=\"ranking\">\n<thead><tr><th scope=\"col\">Suspect</th>"
         "<th scope=\"col\">Probability</th><th scope=\"col\">Strength, if it is this alone</th><th scope=\"col\">Gap "
         "left</th></tr></thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string joined(const std::vector<std::string>& names, const char* between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + words_of_suspect(name);
  return text;
}

std::string settings_of(const NextExperiment& next) {
  std::string text;
  for (const auto& [key, value] : next.set) text += fmt::format("{}{} = {:g}", text.empty() ? "" : ", ", key, value);
  return text.empty() ? "as before" : text;
}

// Each pair once, at the name that most pairs have.
std::string alike_html(std::vector<std::vector<std::string>> pairs) {
  std::string out;
  while (!pairs.empty()) {
    std::map<std::string, int> count;
    for (const auto& pair : pairs)
      for (const std::string& name : pair) ++count[name];
    const std::string& most = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) {
                                return a.second < b.second;
                              })->first;
    std::vector<std::string> others;
    std::erase_if(pairs, [&](const auto& pair) {
      if (std::find(pair.begin(), pair.end(), most) == pair.end()) return false;
      for (const std::string& name : pair)
        if (name != most) others.push_back(name);
      return true;
    });
    out += "<li>" + escaped(with_capital(joined({most}, "")) + ": " + joined(others, ", ")) + "</li>";
  }
  return out;
}

// --- what is new in a text, line by line

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Which lines of b are not in a: by the longest common subsequence.
std::vector<bool> new_lines(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::size_t> length((n + 1) * (m + 1), 0);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return length[i * (m + 1) + j]; };
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t j = m; j-- > 0;)
      at(i, j) = a[i] == b[j] ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
  std::vector<bool> is_new(m, true);
  for (std::size_t i = 0, j = 0; i < n && j < m;) {
    if (a[i] == b[j])
      is_new[j++] = false, ++i;
    else if (at(i + 1, j) >= at(i, j + 1))
      ++i;
    else
      ++j;
  }
  return is_new;
}

}  // namespace

std::string suspects_html(const Diagnosis& d) {
  if (d.ranking.empty()) return "";
  PageTable ruled_out;
  ruled_out.title = "Ruled out";
  ruled_out.header = {"suspect", "probability", "gap left", "by what"};
  std::string out = "<section>\n<h2>Who may have done it</h2>\n" + ranking_html(d, ruled_out);
  out +=
      "<p class=\"note\">Probability that it is in the mill, all suspects weighed against each other; several may be "
      "in it together. "
      "Gap left: what remains if it alone is added; 1 is agreement.</p>\n";
  if (!ruled_out.rows.empty()) out += table_html(ruled_out);
  if (!d.alike.empty()) {
    out += "<h3>What such data cannot tell apart</h3>\n<ul class=\"plain-list\">" + alike_html(d.alike);
    out +=
        "</ul>\n<p class=\"note\">Known before the data were looked at: from what was measured, and how "
        "precisely.</p>\n";
  }
  return out + "</section>\n";
}

std::string next_html(const Diagnosis& d) {
  if (d.next.empty()) return "";
  const NextExperiment& best = d.next.front();
  std::string out =
      "<section>\n<h2>What to measure next</h2>\n<p class=\"next\">" + escaped(with_capital(best.measure)) + "</p>\n";
  PageTable table;
  table.header = {"experiment", "settings", "tells apart", "evidence", "cost"};
  for (const NextExperiment& n : d.next)
    table.rows.push_back({with_capital(n.measure), settings_of(n), joined(n.separates, " – "),
                          one_digit(n.expected_log_evidence),
                          std::isnan(n.cost) ? "–" : fmt::format("{:.2g}", n.cost)});
  table.note =
      "Evidence: expected logarithm of the odds that it would give; 3 is 20 to 1, 5 is 150 to 1. Cost: "
      "against one more "
      "measurement like those given.";
  return out + table_html(table) + "</section>\n";
}

std::string model_html(const Diagnosis& d) {
  if (d.model_toml.empty() || d.model_toml == d.mill_toml) return "";
  const auto lines = lines_of(d.model_toml);
  const auto is_new = new_lines(lines_of(d.mill_toml), lines);
  std::string code;
  for (std::size_t i = 0; i < lines.size(); ++i)
    code += is_new[i] && !lines[i].empty() ? "<ins>" + escaped(lines[i]) + "</ins>\n" : escaped(lines[i]) + "\n";
  return "<section>\n<h2>The model with what was found</h2>\n<p>model.toml; what is new in it is marked. Copy the "
         "lines into your MILL.toml, or use the "
         "file as it is.</p>\n<pre class=\"lines\" tabindex=\"0\">" +
         code + "</pre>\n</section>\n";
}

}  // namespace tumble::io::report
