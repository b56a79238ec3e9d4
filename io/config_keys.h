#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "core/config.h"

// The table of MILL.toml's keys: one row serves reading, --set, the search for the nearest key, and writing.
namespace tumble::io {

// A number that may also be the word "auto".
struct AutoNumber {
  double& (*value)(Config&);
  bool (*is_auto)(const Config&);
  void (*set_auto)(Config&, bool);
};
struct BallList {};   // charge.balls: an array of tables, read and written by its own code
struct PointList {};  // mill.lifters.points: an array of pairs

// How to reach the key's field in a Config.
using Field =
    std::variant<double& (*)(Config&), int& (*)(Config&), std::optional<int>& (*)(Config&), std::uint64_t& (*)(Config&),
                 LifterProfile& (*)(Config&), ContactLaw& (*)(Config&), AutoNumber, BallList, PointList>;

struct Key {
  std::string path;    // "mill.lifters.height"
  std::string wanted;  // kind, unit and range, as a message says it: "a length in m, > 0"
  std::string meaning;
  Field field;
  std::string excludes = {};  // the other way to say the same thing: a file gives one, --set of one removes the other
};

std::span<const Key> config_keys();
const Key* find_key(const std::string& path);  // nullptr where there is none

// Is this a table of MILL.toml ("mill.lifters")?
bool is_section(const std::string& path);

// The known key that was probably meant, by edit distance; a right name in a wrong table counts as near.
std::string nearest_key(const std::string& path);
// The same for a table's name.
std::string nearest_section(const std::string& path);
// The nearest of `words` to `word`.
std::string nearest_word(const std::string& word, std::span<const std::string> words);

// Back to "not given", for a key that another one excludes.
void clear_field(const Key& key, Config& config);

// The value that a config has for a key of MILL.toml; speed and filling either way that they can be given. NaN where
// that is no number.
double number_at(const Config& config, const std::string& key);

}  // namespace tumble::io
