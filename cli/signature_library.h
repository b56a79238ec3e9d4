#pragma once
#include <filesystem>
#include <vector>

#include "cli/slurm_queue.h"
#include "core/config.h"
#include "core/experiments.h"
#include "core/progress.h"
#include "diagnose/build_library.h"

// The library of signatures that a diagnosis stands on, in its files.
namespace tumble::cli {

struct LibraryPlan {
  std::filesystem::path folder;  // of all libraries
  std::size_t blocks = 0;
  std::vector<UncertainKey> uncertain;
  std::vector<Config> mills;  // of the experiments that are not held out
};

// What the mill has for the uncertain keys. Throws InputError where it has nothing.
std::vector<double> values_of(const Config& mill, const std::vector<UncertainKey>& uncertain);

std::vector<diagnose::Condition> conditions_of(const LibraryPlan& plan);

// Fills the conditions' runs; what is not in the files is simulated. Returns the number of simulations.
std::size_t build_library(const LibraryPlan& plan, std::vector<diagnose::Condition>& conditions,
                          const Progress& progress);

// Has Slurm make the files that are not there yet. Returns the number of simulations.
std::size_t make_library_by_slurm(const LibraryPlan& plan, const std::filesystem::path& queue, int threads,
                                  const Progress& progress);
void library_task(const SlurmTask& task);  // its part of that

}  // namespace tumble::cli
