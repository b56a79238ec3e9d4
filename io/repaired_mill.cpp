#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "core/effects.h"
#include "core/suspect_words.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/diagnosis_file.h"
#include "io/diagnosis_words.h"

// MILL.toml is its author's file: values are changed where they stand and lines are added, nothing else moves. What an
// editor of lines cannot do (a table that was written as dotted keys) is noticed by reading the result again; then the
// file is written anew.
namespace tumble::io {
namespace {

struct Change {
  std::string key, value;  // as --set takes them
  std::string note;        // beside the value
};

// --- numbers

// As many digits as the error gives meaning to (two of its own).
std::string rounded(const Estimate& e) {
  if (!(e.se > 0) || !std::isfinite(e.se)) return fmt::format("{:.4g}", e.value);
  const int decimals = std::clamp(1 - static_cast<int>(std::floor(std::log10(e.se))), 0, 15);
  return fmt::format("{}", std::stod(fmt::format("{:.{}f}", e.value, decimals)));
}

bool is_whole(const std::string& key) {
  const Key* known = find_key(key);
  return known != nullptr && (std::holds_alternative<std::optional<int>& (*)(Config&)>(known->field) ||
                              std::holds_alternative<int& (*)(Config&)>(known->field));
}

std::string plus_minus(const Estimate& e) { return e.se > 0 ? ", ± " + rounded({e.se, e.se}) : ""; }

// --- what was found, as keys

double or_none(double v) { return std::isnan(v) ? 0 : v; }

// The mean torque of the whole mill that was measured, for offsets that are shares of it.
double mean_torque(const Diagnosis& d, const Config& mill) {
  double sum = 0;
  int count = 0;
  for (const GapRow& row : d.gaps) {
    if (row.hold_out || std::isnan(row.torque_measured.value)) continue;
    sum += row.torque_measured.value;
    ++count;
  }
  return sum / count * slice_count(mill);
}

// On top of what MILL.toml's [measurement] has already: the data were put right by that before they were looked at.
Change measuring_error(const std::string& name, double before, const Estimate& found, bool is_share,
                       const std::string& note) {
  const double value = is_share ? (1 + or_none(before)) * (1 + found.value) - 1 : or_none(before) + found.value;
  return {"measurement." + name, rounded({value, found.se}), note};
}

// What was told of the mill's speed or filling, put right by a share.
Change corrected(const Config& mill, const std::string& key, const Estimate& share, const std::string& note) {
  const double value = number_at(mill, key);
  if (is_whole(key)) return {key, fmt::format("{:.0f}", value * (1 + share.value)), note};
  return {key, rounded({value * (1 + share.value), value * share.se}), note};
}

std::vector<Change> changes_of(const FoundEffect& effect, const Config& mill, const Diagnosis& d) {
  std::vector<Change> all;
  const FoundParameter first = effect.parameters.empty() ? FoundParameter{} : effect.parameters.front();
  const Estimate& found = first.value;
  const MeasurementErrors& errors = mill.measurement;
  const std::string name = words_of_suspect(effect.name);
  const std::string sure = std::isfinite(effect.probability)
                               ? fmt::format(", probability {}", probability_in_words(effect.probability))
                               : "";
  const std::string note = name + " " + parameter_in_words(first) + sure;  // of an artefact
  if (effect.kind == NameKind::kPhysics) {
    for (const FoundParameter& p : effect.parameters) {
      const Effect* known = find_effect(effect.name);
      if (known == nullptr || find_parameter(*known, p.name) == nullptr) continue;  // what MILL.toml cannot say
      all.push_back({"effects." + effect.name + "." + p.name, rounded(p.value), name + plus_minus(p.value) + sure});
    }
  } else if (effect.name == "camera_scale") {
    all.push_back(measuring_error("camera_scale", errors.camera_scale, found, true, note));
  } else if (effect.name == "camera_rotation") {
    all.push_back(measuring_error("camera_rotation_deg", errors.camera_rotation_deg, found, false, note));
  } else if (effect.name == "frame_clock") {
    all.push_back(measuring_error("frame_clock", errors.frame_clock, found, true, note));
  } else if (effect.name == "torque_offset") {
    const double unit = first.name == "relative" ? mean_torque(d, mill) : 1;
    all.push_back(measuring_error("torque_offset_N_m", errors.torque_offset_N_m,
                                  {unit * found.value, std::abs(unit) * found.se}, false, note));
  } else if (effect.name == "filling_error") {
    all.push_back(corrected(mill, mill.charge.count ? "charge.count" : "charge.filling", found, note));
    all.push_back(measuring_error("filling_error", errors.filling_error, found, true, "of what experiments set"));
  } else if (effect.name == "speed_error") {
    const bool by_share = !std::isnan(mill.mill.speed);
    all.push_back(corrected(mill, by_share ? "mill.speed" : "mill.speed_rpm", found, note));
    all.push_back(measuring_error("speed_error", errors.speed_error, found, true, "of what experiments set"));
  }
  for (const std::string& set : effect.sets) {
    const auto equals = set.find('=');
    const std::string key = set.substr(0, equals);
    if (std::none_of(all.begin(), all.end(), [&](const Change& c) { return c.key == key; }))
      all.push_back({key, set.substr(equals + 1), ""});
  }
  return all;
}

std::vector<Change> refitted(const std::vector<FittedUncertain>& keys) {
  std::vector<Change> all;
  for (const FittedUncertain& k : keys) {
    if (std::isnan(k.found.value)) continue;
    const std::string value = is_whole(k.key) ? fmt::format("{:.0f}", k.found.value) : rounded(k.found);
    if (value == fmt::format("{}", k.given)) continue;
    all.push_back({k.key, value, "refitted" + plus_minus(k.found)});
  }
  return all;
}

// --- the text

class Editor {
 public:
  explicit Editor(std::string text) : text_(std::move(text)) {
    if (!text_.empty() && text_.back() != '\n') text_ += '\n';
  }
  const std::string& text() const { return text_; }

  void set(const Change& change) {
    const toml::table document = toml::parse(text_);
    if (replace(document, change.key, change)) return;
    if (const std::string twin = twin_of(change.key); !twin.empty() && replace(document, twin, change)) return;
    const std::string section = change.key.substr(0, change.key.rfind('.'));
    const std::string line = leaf(change.key) + " = " + change.value + beside(change.note) + "\n";
    const toml::node* table = document.at_path(section).node();
    if (table != nullptr && table->is_table() && !table->as_table()->is_inline() && starts_with_header(*table))
      text_.insert(after_last_of(*table->as_table()), line);
    else
      text_ += fmt::format("\n[{}]\n{}", section, line);
  }
  void end_with(const std::vector<std::string>& remarks) {
    for (const std::string& remark : remarks) text_ += (&remark == &remarks.front() ? "\n# " : "# ") + remark + "\n";
  }

 private:
  static std::string leaf(const std::string& key) { return key.substr(key.rfind('.') + 1); }
  static std::string beside(const std::string& note) { return note.empty() ? "" : "  # " + note; }

  // A position of toml++ (line and column from 1, columns in characters) as an index into the text.
  std::size_t index_of(const toml::source_position& at) const {
    std::size_t i = line_begin(at.line);
    for (toml::source_index column = 1; column < at.column; ++i)
      if (i + 1 >= text_.size() || (static_cast<unsigned char>(text_[i + 1]) & 0xC0u) != 0x80u) ++column;
    return i;
  }
  std::size_t line_begin(toml::source_index line) const {
    std::size_t i = 0;
    for (toml::source_index n = 1; n < line; ++n) i = text_.find('\n', i) + 1;
    return i;
  }

  // The value of `key`, and its name where `change` has another one (speed_rpm for speed), in their place; what was
  // there stands above.
  bool replace(const toml::table& document, const std::string& key, const Change& change) {
    const toml::node* node = document.at_path(key).node();
    if (node == nullptr || node->is_table()) return false;
    const std::size_t begin = index_of(node->source().begin), end = index_of(node->source().end);
    const std::string before = text_.substr(begin, end - begin);
    text_.replace(begin, end - begin, change.value);
    keep_column(begin + change.value.size(), static_cast<std::ptrdiff_t>(change.value.size() - before.size()));
    std::size_t first = begin;
    if (key != change.key) {
      first = text_.rfind(leaf(key), begin);
      text_.replace(first, leaf(key).size(), leaf(change.key));
    }
    const std::size_t line = text_.rfind('\n', first) + 1;  // npos + 1 is the beginning
    const std::string indent = text_.substr(line, text_.find_first_not_of(" \t", line) - line);
    const bool one_line = before.find('\n') == std::string::npos;
    text_.insert(line, fmt::format("{}# was {}{}{}\n", indent, key == change.key ? "" : leaf(key) + " = ",
                                   one_line ? before : "another list", change.note.empty() ? "" : "; " + change.note));
    return true;
  }

  // A remark beside a value that became so much longer stays where it stood, if there is room.
  void keep_column(std::size_t at, std::ptrdiff_t longer) {
    const std::size_t hash = text_.find_first_not_of(' ', at);
    if (hash == at || hash == std::string::npos || text_[hash] != '#') return;
    const auto room = static_cast<std::ptrdiff_t>(hash - at);
    text_.replace(at, hash - at, static_cast<std::size_t>(std::max<std::ptrdiff_t>(2, room - longer)), ' ');
  }

  bool starts_with_header(const toml::node& table) const {
    const auto& at = table.source().begin;
    return at.line > 0 && text_[index_of(at)] == '[';
  }

  // Behind the last line that gives a value of the table itself.
  std::size_t after_last_of(const toml::table& table) const {
    toml::source_index last = table.source().begin.line;
    for (const auto& [name, node] : table)
      if (!node.is_table() || node.as_table()->is_inline()) last = std::max(last, node.source().end.line);
    return line_begin(last + 1);
  }

  std::string text_;
};

// The text with these changes, or the mill written anew where they cannot be put between its lines.
std::string with_changes(const std::string& mill_toml, const std::string& name, const std::vector<Change>& changes,
                         const std::vector<std::string>& remarks = {}) {
  std::vector<std::string> sets;
  for (const Change& change : changes) sets.push_back(change.key + "=" + change.value);
  const Config meant = with_sets(parse_config(mill_toml, name), sets);
  Editor editor(mill_toml);
  bool right = true;
  try {
    for (const Change& change : changes) editor.set(change);
    right = to_toml(parse_config(editor.text(), name)) == to_toml(meant);
  } catch (const std::exception&) {  // an edit made it no TOML
    right = false;
  }
  if (!right)
    editor = Editor("# Written anew: what was found could not be written between the lines.\n" + to_toml(meant));
  editor.end_with(remarks);
  return editor.text();
}

}  // namespace

std::string repaired_mill(const std::string& mill_toml, const std::string& name, const Diagnosis& d) {
  if (d.finding == Finding::kAgreement || d.finding == Finding::kUnknownEffect || d.effects.empty()) return mill_toml;
  const Config mill = parse_config(mill_toml, name);
  std::vector<FoundEffect> added = d.effects, rivals;
  if (d.finding == Finding::kAmbiguous) {
    const auto likeliest = std::max_element(added.begin(), added.end(),
                                            [](const auto& a, const auto& b) { return a.probability < b.probability; });
    std::swap(*added.begin(), *likeliest);
    rivals.assign(added.begin() + 1, added.end());
    added.resize(1);
  }
  std::vector<Change> changes;
  for (const FoundEffect& effect : added)
    for (Change& change : changes_of(effect, mill, d)) changes.push_back(std::move(change));
  if (!changes.empty())
    for (Change& change : refitted(d.keys)) changes.push_back(std::move(change));

  std::vector<std::string> remarks;
  for (const FoundEffect& rival : rivals) {
    std::string instead;
    for (const Change& change : changes_of(rival, mill, d))
      instead += fmt::format(" --set {}={}", change.key, change.value);
    remarks.push_back(fmt::format("{} (probability {}) explains the data about as well{}", words_of_suspect(rival.name),
                                  probability_in_words(rival.probability),
                                  instead.empty() ? "" : "; in its place:" + instead));
  }
  return with_changes(mill_toml, name, changes, remarks);
}

std::string tabulated_mill(const std::string& mill_toml, const std::string& name, const Diagnosis& d,
                           const std::vector<std::string>& sets) {
  std::vector<Change> changes = refitted(d.keys);
  for (const std::string& set : sets) {
    const auto equals = set.find('=');
    changes.push_back({set.substr(0, equals), set.substr(equals + 1), "by regression"});
  }
  return with_changes(mill_toml, name, changes);
}

}  // namespace tumble::io
