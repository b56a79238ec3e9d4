#include "io/diagnosis_words.h"

#include <fmt/format.h>

#include <algorithm>
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

std::string gap_in_words(const Diagnosis& d) {
  const Gap before = gap_before(d), after = gap_after(d);
  if (std::isnan(before.fit) || std::isnan(after.fit)) return "";
  const auto change = [](double from, double to) {
    return fmt::format("{} from {:.2g} to {:.2g}", to < from ? "falls" : "goes", from, to);
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
             gap_in_words(d);
    case Finding::kUnknownEffect:
      return "No suspect explains what was measured" + with_probability(d, "unknown") +
             ". Below is where it shows; nothing was added to the model." + gap_in_words(d);
    case Finding::kAmbiguous: {
      std::string text = "Each of these explains the data about as well: ";
      for (std::size_t i = 0; i < d.effects.size(); ++i)
        text += (i > 0 ? "; " : "") + words_of_suspect(d.effects[i].name) + " (" + numbers_of(d.effects[i]) + ")";
      text += ".";
      if (!d.next.empty()) text += " To tell them apart: " + d.next.front().measure + ".";
      return text;
    }
    default:
      break;
  }
  std::string text;
  for (const FoundEffect& e : d.effects)
    text += fmt::format("{}{}: {}.", text.empty() ? "" : " ", statement_of_suspect(e.name, strength_of(e)),
                        words_of_suspect(e.name) + (numbers_of(e).empty() ? "" : ", " + numbers_of(e)));
  return text + gap_in_words(d);
}

}  // namespace tumble::io
