#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "core/config.h"
#include "core/run_outcome.h"

namespace tumble::io {

// The outcomes of finished runs, a line of text each, appended the moment a run ends: whatever kills the program, what
// was finished is kept, and a line cut short counts as not there. A run is known again by its config, seed included,
// so the order of the runs and what else the campaign holds do not matter. Doubles come back to the bit.
class RunJournal {
 public:
  // With `resume`, goes on with what the file holds, if this version of the program wrote it; else starts afresh.
  RunJournal(std::filesystem::path path, bool resume);
  ~RunJournal();
  RunJournal(const RunJournal&) = delete;
  RunJournal& operator=(const RunJournal&) = delete;

  std::size_t size() const { return known_.size(); }
  bool find(const Config& config, RunOutcome& outcome) const;
  void add(const Config& config, const RunOutcome& outcome);  // throws WorkError where the disk refuses
  // Adds what another journal, which may be growing meanwhile, holds beyond the byte `from`; that moves on to the end
  // of what was whole. A file that is not there, or of another version, holds nothing.
  void take(const std::filesystem::path& other, std::uintmax_t& from);

  // A run's name in the file, for whoever asks after it often.
  static std::uint64_t key_of(const Config& config);
  bool has(std::uint64_t key) const { return known_.contains(key); }

  void remove();  // once its content stands elsewhere

 private:
  void add(std::uint64_t key, const RunOutcome& outcome);
  void append(const std::string& line);

  std::filesystem::path path_;
  std::map<std::uint64_t, RunOutcome> known_;
  int file_ = -1;
};

}  // namespace tumble::io
