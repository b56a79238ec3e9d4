#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/progress.h"

// Independent pieces of work, done by the tasks of Slurm's job arrays. What is done is what has its result on the file
// system that all nodes share: Slurm is asked to run things, and never believed about what became of them.
namespace tumble::cli {

struct SlurmWork {
  std::filesystem::path folder;  // the queue's own, seen by all nodes; removed when all is done
  std::string kind;              // who does it: see tasks.cpp
  nlohmann::json plan;           // all that the tasks need to know, the numbers of their pieces apart
  std::size_t pieces = 0;        // in all
  std::size_t per_task = 1;      // at least so many to a task
  int threads = 1;               // of a task
  std::function<std::vector<std::size_t>()> left{};  // the pieces without a result; asked again and again
};

// Throws WorkError in one line where Slurm is not installed or its controller does not answer.
void check_slurm();

// Returns when no piece is left. Tasks that die, run out of time or get lost: once all have ended, what is left is
// submitted again, in smaller portions; three times in a row without any new result are a WorkError. A controller that
// was there may be away for ten minutes. Jobs of a start that was killed are waited for, not doubled. However it ends,
// no job stays behind.
void do_by_slurm(const SlurmWork& work, const Progress& progress);

// Cancels what an earlier start may have left in the queue, and removes the folder.
void discard_slurm_queue(const std::filesystem::path& folder);

// What one task of an array is to do.
struct SlurmTask {
  std::string kind;
  nlohmann::json plan;
  std::vector<std::size_t> pieces;
  std::filesystem::path own;  // a name in the queue's folder that is this task's alone
};
SlurmTask read_slurm_task(const std::filesystem::path& manifest, std::size_t number);

}  // namespace tumble::cli
