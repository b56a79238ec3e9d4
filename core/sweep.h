#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/run_outcome.h"

namespace tumble {

struct VariedKey {
  std::string key;                  // of MILL.toml, in full
  std::vector<std::string> values;  // as --set takes them
};

// Many runs of one mill: every combination of the varied keys' values (a point; the last key changes fastest), each
// `repeats` times with other packings.
struct Sweep {
  std::string mill_toml;  // the mill before anything is varied
  std::vector<VariedKey> varied;
  std::uint64_t first_seed = 1;  // repeat k has seed first_seed + k
  std::size_t repeats = 1;
  std::vector<RunOutcome> runs;  // point by point, repeat by repeat

  std::size_t points() const {
    std::size_t n = 1;
    for (const VariedKey& v : varied) n *= v.values.size();
    return n;
  }
  // Which of its values each varied key has at a point.
  std::vector<std::size_t> at(std::size_t point) const {
    std::vector<std::size_t> index(varied.size());
    for (std::size_t k = varied.size(); k-- > 0; point /= varied[k].values.size())
      index[k] = point % varied[k].values.size();
    return index;
  }
};

}  // namespace tumble
