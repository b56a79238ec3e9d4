#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "core/error.h"
#include "io/json_number.h"
#include "trials/key_file.h"
#include "trials/score.h"
#include "trials/verbs.h"

namespace tumble::trials {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

struct Options : cli::CommonOptions {
  fs::path data, keys, verdicts;
};

std::vector<Judged> read_all(const Options& o) {
  std::vector<Judged> trials;
  for (OpenedKey& opened : open_keys(o.data, o.keys)) {
    if (!opened.sealed)
      throw InputError(key_path(o.keys, opened.key.name).string(),
                       "is not the key that was sealed; its SHA-256 is not that in " + (o.data / kSealsFile).string());
    Verdict verdict = read_verdict(o.verdicts / opened.key.name / "verdict.json");
    trials.push_back({std::move(opened.key), std::move(verdict)});
  }
  return trials;
}

const char* outcome(const Bar& bar) {
  if (bar.number.empty()) return "";
  if (!bar.tried()) return "not tried";
  return bar.met() ? "met" : "MISSED";
}

std::string shown(const Bar& bar, double value) {
  return bar.is_share ? fmt::format("{:.1f} %", 100 * value) : fmt::format("{:.2f}", value);
}

std::string wanted(const Bar& bar) {
  const bool least = !std::isnan(bar.least), most = !std::isnan(bar.most);
  if (least && most) return fmt::format("{:g} to {:g}", bar.least, bar.most);
  if (!least && !most) return "";
  const double limit = least ? bar.least : bar.most;
  return (least ? ">= " : "<= ") + (bar.is_share ? fmt::format("{:g} %", 100 * limit) : fmt::format("{:g}", limit));
}

std::string counted(const std::vector<Judged>& trials) {
  std::vector<std::pair<std::string, int>> kinds;
  for (const Judged& t : trials) {
    const std::string name = fmt::format("{} from {}", name_of(t.key.kind), name_of(t.key.tier));
    const auto it = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == name; });
    if (it == kinds.end())
      kinds.emplace_back(name, 1);
    else
      ++it->second;
  }
  std::sort(kinds.begin(), kinds.end());
  std::string text;
  for (const auto& [name, n] : kinds) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, name);
  return text;
}

std::string table(const std::vector<Judged>& trials, const Score& score) {
  std::string text = fmt::format("{} trials, all seals hold: {}\n\n", trials.size(), counted(trials));
  text += fmt::format("{:>3}  {:<70} {:>9}  {:<17} {:>4}  {:<10} {}\n", "bar", "", "measured", "95 % interval", "n",
                      "wanted", "");
  for (const Bar& b : score.bars) {
    const std::string interval =
        b.tried() ? fmt::format("{} to {}", shown(b, b.measured.low), shown(b, b.measured.high)) : "";
    std::string line =
        fmt::format("{:>3}  {:<70} {:>9}  {:<17} {:>4}  {:<10} {}", b.number, b.demand,
                    b.tried() ? shown(b, b.measured.value) : "-", interval, b.measured.n, wanted(b), outcome(b));
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  text += "\nhidden, and what was said of it\n";
  for (const auto& [hidden, answers] : score.confusion) {
    std::vector<std::pair<int, std::string>> sorted;
    for (const auto& [said, n] : answers) sorted.emplace_back(-n, said);
    std::sort(sorted.begin(), sorted.end());
    std::string line;
    for (const auto& [n, said] : sorted) line += fmt::format("{}{} x {}", line.empty() ? "" : ";  ", -n, said);
    text += fmt::format("  {:<42} {}\n", hidden, line);
  }
  for (const Judged& t : trials)
    if (!t.verdict.broken.empty()) text += fmt::format("{}: no verdict: {}\n", t.key.name, t.verdict.broken);
  return text;
}

Json json_of(const std::vector<Judged>& trials, const Score& score) {
  Json bars = Json::array(), confusion = Json::object(), broken = Json::array();
  for (const Bar& b : score.bars) {
    Json bar = {{"bar", b.number}, {"demand", b.demand}, {"n", b.measured.n}};
    bar["measured"] = io::json_number(b.measured.value, 9);
    bar["interval_95"] = {io::json_number(b.measured.low, 9), io::json_number(b.measured.high, 9)};
    bar["least"] = io::json_number(b.least, 9);
    bar["most"] = io::json_number(b.most, 9);
    bar["met"] = b.tried() && !b.number.empty() ? Json(b.met()) : Json();
    bars.push_back(std::move(bar));
  }
  for (const auto& [hidden, answers] : score.confusion) confusion[hidden] = answers;
  for (const Judged& t : trials)
    if (!t.verdict.broken.empty()) broken.push_back({{"trial", t.key.name}, {"why", t.verdict.broken}});
  return {{"trials", trials.size()}, {"bars", bars}, {"confusion", confusion}, {"no_verdict", broken}};
}

void run(const Options& o) {
  const std::vector<Judged> trials = read_all(o);
  const Score all = score(trials);
  cli::print(o.json ? json_of(trials, all).dump(2) + "\n" : table(trials, all));
}

}  // namespace

void add_score(CLI::App& trials) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = trials.add_subcommand("score", "Check the seals, open the keys, and score verdicts");
  verb->add_option("data", o->data, "The folder that `tumble trials make` wrote: its seals.txt is read")->required();
  verb->add_option("keys", o->keys, "The folder with the keys")->required();
  verb->add_option("verdicts", o->verdicts, "A folder with 0001/verdict.json ...; what is missing counts as wrong")
      ->required();
  cli::add_common(*verb, *o);
  verb->footer("Example: tumble trials score trials trials-keys verdicts");
  verb->callback([o] { run(*o); });
}

}  // namespace tumble::trials
