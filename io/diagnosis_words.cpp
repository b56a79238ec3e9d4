#include "io/diagnosis_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/suspect_words.h"
#include "io/report/html.h"

namespace tumble::io {
namespace {

using report::with_error;

// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::vector<std::string> names_of(const std::vector<FoundEffect>& effects) {
  std::vector<std::string> names;
  for (const FoundEffect& e : effects) names.push_back(words_of_suspect(e.name));
  return names;
}

double strength_of(const FoundEffect& effect) {
  return effect.parameters.empty() ? kNotGiven : effect.parameters.front().value.value;
}

// "coefficient 0.0213 ± 0.0031", "+2.0 ± 0.1 %", "probability 0.98"
std::string numbers_of(const FoundEffect& effect) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  for (const FoundParameter& p : effect.parameters) add(parameter_in_words(p));
  if (std::isfinite(effect.probability)) add("probability " + probability_in_words(effect.probability));
  return text;
}

std::string change_of_gap(const Diagnosis& d) {
  const Gap before = gap_before(d), after = gap_after(d);
  if (std::isnan(before.fit) || std::isnan(after.fit)) return "";
  const auto change = [](double from, double to) {
    return fmt::format("{} from {} to {}", to < from ? "falls" : "goes", gap_in_words(from), gap_in_words(to));
  };
  std::string text = " The gap " + change(before.fit, after.fit);
  if (std::isfinite(before.hold_out) && std::isfinite(after.hold_out))
    text += ", on experiments that had no part in the fit it " + change(before.hold_out, after.hold_out);
  return text + " (1 is agreement).";
}

double probability_of(const Diagnosis& d, const char* name) {
  for (const RankedName& r : d.ranking)
    if (r.name == name) return r.probability;
  return kNotGiven;
}

std::string with_probability(const Diagnosis& d, const char* name) {
  const double p = probability_of(d, name);
  return std::isnan(p) ? "" : ", probability " + probability_in_words(p);
}

}  // namespace

std::string probability_in_words(double p) {
  if (std::isnan(p)) return "–";
  if (p > 0.999) return "above 0.999";
  if (p < 0.001) return "below 0.001";
  return fmt::format("{:.{}f}", p, p > 0.99 || p < 0.01 ? 3 : 2);
}

std::string gap_in_words(double chi) {
  return std::isnan(chi) ? "–" : chi < 9.95 ? fmt::format("{:.1f}", chi) : fmt::format("{:.0f}", chi);
}

std::string parameter_in_words(const FoundParameter& p) {
  const bool share = p.name == "relative";
  const double factor = share ? 100 : 1;
  std::string text = with_error({factor * p.value.value, factor * p.value.se});
  if (p.value.value > 0 && share) text = "+" + text;
  if (share) return text + "\u00a0%";
  if (p.unit == "deg") return text + "°";
  std::string name = p.name;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + " " + text + (p.unit.empty() ? "" : "\u00a0" + p.unit);
}

std::string diagnosis_title(const Diagnosis& d) {
  switch (d.finding) {
    case Finding::kAgreement:
      return "Model and measurement agree";
    case Finding::kUnknownEffect:
      return "Something is missing that is not on the list";
    case Finding::kAmbiguous:
      return d.effects.size() == 2 ? "The data cannot tell " + words_of_suspect(d.effects[0].name) + " from " +
                                         words_of_suspect(d.effects[1].name)
                                   : "The data cannot tell apart " + listed(names_of(d.effects));
    default:
      break;
  }
  if (d.effects.size() == 1) return statement_of_suspect(d.effects[0].name, strength_of(d.effects[0]));
  return "Several things are off: " + listed(names_of(d.effects));
}

std::string diagnosis_sentence(const Diagnosis& d) {
  switch (d.finding) {
    case Finding::kAgreement:
      return "Nothing in these data asks for more than the model has" + with_probability(d, "none") + "." +
             change_of_gap(d);
    case Finding::kUnknownEffect:
      return "No suspect explains what was measured" + with_probability(d, "unknown") +
             ". Below is where it shows; nothing was added to the model." + change_of_gap(d);
    case Finding::kAmbiguous: {
      std::vector<std::string> probabilities;
      for (const FoundEffect& e : d.effects) probabilities.push_back(probability_in_words(e.probability));
      std::string text = diagnosis_title(d) + ": probabilities " + listed(probabilities) + ".";
      if (!d.next.empty()) text += " What would tell: " + d.next.front().measure + ".";
      return text;
    }
    default:
      break;
  }
  std::string text;
  for (const FoundEffect& e : d.effects)
    text += fmt::format("{}{}: {}.", text.empty() ? "" : " ", statement_of_suspect(e.name, strength_of(e)),
                        words_of_suspect(e.name) + (numbers_of(e).empty() ? "" : ", " + numbers_of(e)));
  return text + change_of_gap(d);
}

std::string sentence_below_title(const Diagnosis& d) {
  const std::string sentence = d.sentence.empty() ? diagnosis_sentence(d) : d.sentence,
                    title = diagnosis_title(d) + ": ";
  return sentence.starts_with(title) ? with_capital(sentence.substr(title.size())) : sentence;
}

std::string with_capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string gaps_in_words(double from, double to) {
  return gap_in_words(from) + (std::isnan(to) ? "" : " → " + gap_in_words(to));
}

std::string condition_in_words(const DiagnosedExperiment& e) {
  std::string text;
  if (std::isfinite(e.speed_fraction)) text = fmt::format("{:.2f} of critical", e.speed_fraction);
  if (std::isfinite(e.filling)) text += fmt::format("{}{:.0f} % full", text.empty() ? "" : ", ", 100 * e.filling);
  return text;
}

}  // namespace tumble::io
