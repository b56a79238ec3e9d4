#include "trials/key_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "io/sha256.h"
#include "io/text_file.h"

namespace tumble::trials {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLargestMiB = 16;

// Numbers to the last bit: what was simulated can be simulated again.
Json json_of(const Hidden& h) {
  return {{"name", h.name},         {"nature", name_of(h.nature)},
          {"strength", h.strength}, {"parameter", h.parameter},
          {"value", h.value},       {"sets", h.sets}};
}

Hidden hidden_of(const Json& j) {
  return {j.at("name"),     nature_named(j.at("nature")),
          j.at("strength"), j.at("parameter"),
          j.at("value"),    j.at("sets").get<std::vector<std::string>>()};
}

}  // namespace

std::string key_text(const TrialKey& key) {
  Json j = {{"trial", key.name}, {"salt", key.salt}, {"kind", name_of(key.kind)}, {"data", name_of(key.tier)}};
  j["hidden"] = Json::array();
  for (const Hidden& h : key.hidden) j["hidden"].push_back(json_of(h));
  j["uncertain"] = Json::object();
  for (const auto& [name, value] : key.uncertain) j["uncertain"][name] = value;
  j["seed"] = key.seed;
  return j.dump(2) + "\n";
}

TrialKey parse_key(const std::string& text, const std::string& name) {
  try {
    const Json j = Json::parse(text);
    TrialKey key{j.at("trial"), j.at("salt"), kind_named(j.at("kind")), tier_named(j.at("data")), {}, {}, j.at("seed")};
    for (const Json& h : j.at("hidden")) key.hidden.push_back(hidden_of(h));
    for (const auto& [k, value] : j.at("uncertain").items()) key.uncertain.emplace_back(k, value.get<double>());
    return key;
  } catch (const nlohmann::json::exception& e) {
    throw InputError(name, "is no key of a trial (" + io::one_line(e.what()) + ")");
  }
}

fs::path key_path(const fs::path& keys, const std::string& trial) { return keys / (trial + ".json"); }

std::string seals_text(const std::vector<TrialKey>& keys) {
  std::string text;
  for (const TrialKey& key : keys)
    text += fmt::format("{}  {}\n", io::sha256(key_text(key)), key_path("", key.name).string());
  return text;
}

std::vector<OpenedKey> open_keys(const fs::path& data, const fs::path& keys) {
  const fs::path seals = data / kSealsFile;
  std::istringstream lines(io::read_text(seals, "the seals of trials", kLargestMiB));
  std::vector<OpenedKey> opened;
  std::set<std::string> known;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string place = fmt::format("{}:{}", seals.string(), number);
    const auto gap = line.find("  ");
    if (gap != 64 || !line.ends_with(".json") || line.find('/') != std::string::npos)
      throw InputError(place, "is no seal; a line is a SHA-256, two spaces and the key's file name");
    const std::string file = line.substr(gap + 2);
    const std::string text = io::read_text(keys / file, "a trial's key", kLargestMiB);
    OpenedKey key{parse_key(text, (keys / file).string()), io::sha256(text) == line.substr(0, gap)};
    if (key_path("", key.key.name) != file) throw InputError((keys / file).string(), "is the key of " + key.key.name);
    if (!known.insert(file).second) throw InputError(place, "seals " + file + " a second time");
    opened.push_back(std::move(key));
  }
  if (opened.empty()) throw InputError(seals.string(), "holds no seals");
  for (const auto& entry : fs::directory_iterator(keys))
    if (entry.path().extension() == ".json" && !known.contains(entry.path().filename().string()))
      throw InputError(entry.path().string(), "was never sealed; " + seals.string() + " does not have it");
  return opened;
}

}  // namespace tumble::trials
