#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/slurm_queue.h"
#include "core/config.h"
#include "core/progress.h"
#include "core/sweep.h"
#include "io/run_journal.h"

// What a sweep is to simulate, and how Slurm's tasks do it.
namespace tumble::cli {

struct SweepPlan {
  Sweep sweep;
  Config mill;  // that of sweep.mill_toml

  std::vector<std::string> sets_at(std::size_t run) const;  // what is varied, as --set takes it
  Config config_of(std::size_t run) const;
  std::size_t runs() const { return sweep.points() * sweep.repeats; }
};

// About how long all runs take on one core: the first is tried for an instant, the rest is counting.
double seconds_of(const SweepPlan& plan);
bool has_auto_spin_up(const SweepPlan& plan);  // then a guess goes into that

// The finished runs that the tasks of a queue leave in its folder, each in a journal of its own.
class TasksJournals {
 public:
  explicit TasksJournals(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void add_to(io::RunJournal& journal);  // what came since last time

 private:
  std::filesystem::path folder_;
  std::map<std::filesystem::path, std::uintmax_t> read_;  // bytes of each
};

// Brings all runs that the journal does not know yet into it.
void sweep_by_slurm(const SweepPlan& plan, io::RunJournal& journal, const std::filesystem::path& queue, int threads,
                    const Progress& progress);
void sweep_task(const SlurmTask& task);  // its part of that

}  // namespace tumble::cli
