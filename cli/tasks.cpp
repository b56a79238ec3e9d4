#include "cli/tasks.h"

#include <algorithm>
#include <cstdlib>
#include <memory>

#include "cli/options.h"
#include "cli/signature_library.h"
#include "cli/slurm_queue.h"
#include "cli/sweep_plan.h"
#include "core/error.h"
#include "core/parallel_for.h"

namespace tumble::cli {
namespace {

struct Options {
  std::filesystem::path manifest;
  std::size_t number = 0;
};

void do_task(const Options& o) {
  const char* const cores = std::getenv("SLURM_CPUS_PER_TASK");
  limit_threads(cores ? std::max(1, std::atoi(cores)) : 1);  // the machine may be others' too
  const SlurmTask task = read_slurm_task(o.manifest, o.number);
  if (task.kind == "sweep") return sweep_task(task);
  if (task.kind == "library") return library_task(task);
  throw InputError(o.manifest.string(), "is of a kind of work that is not known: " + task.kind);
}

}  // namespace

void add_task(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("task", "What a task of a job array does; called by Slurm alone");
  verb->add_option("manifest", o->manifest)->required();
  verb->add_option("number", o->number)->required();
  verb->callback([o] { do_task(*o); });
}

void add_engine(CLI::App& verb, std::string& engine) {
  verb.add_option("--engine", engine,
                  "local: all cores of this machine; slurm: a cluster's, by tasks of --threads cores (one)")
      ->capture_default_str();
}

bool is_slurm(const std::string& engine) {
  return parse_name<bool>(engine, "--engine", {{"local", false}, {"slurm", true}});
}

}  // namespace tumble::cli
