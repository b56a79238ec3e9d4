#include <filesystem>
#include <memory>

#include "cli/options.h"
#include "cli/run_summary.h"
#include "cli/simulation.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/large_arrays.h"
#include "core/parallel_for.h"
#include "io/config_file.h"
#include "io/output.h"
#include "io/run_file.h"

namespace tumble::cli {
namespace {

namespace fs = std::filesystem;

struct Options : CommonOptions {
  fs::path config, output;
  std::vector<std::string> sets;
  bool resume = false;
};

void simulate(const Options& o) {
  limit_threads(o.threads);
  give_large_arrays_back();
  const Config config = io::read_config(o.config, o.sets);
  check_complete(config);
  io::check_not_input(o.output, o.config);
  if (o.output.extension() == ".xdmf")
    throw InputError(o.output.string(), "is the name of the run's side-car for ParaView; give RUN.h5");
  std::error_code error;
  if (o.resume && !o.force && (fs::exists(o.output, error) || io::adopt_complete_run(o.output, config))) {
    // Done is done, provided that it is this run.
    const io::RunReader run(o.output);
    if (io::to_toml(run.setup().config) != io::to_toml(config))
      throw InputError(o.output.string(), "is a complete run of another config; give another output, or --force");
    say(o, o.output.string() + " is complete");
    if (o.json) print(to_json(summarise(run), run));
    return;
  }
  io::check_output_file(o.output, o.force);
  if (!o.resume && fs::exists(fs::path(o.output) += ".part", error))
    say(o, "note: starting afresh over the interrupted " + o.output.string() +
               ".part; --resume would have gone on with it");
  simulate_to_file(config, o.output, o.resume, o);
  if (o.json) {
    const io::RunReader run(o.output);
    print(to_json(summarise(run), run));
  }
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("simulate", "Simulate the charge of a mill and write its frames");
  verb->add_option("config", o->config, "MILL.toml")->required();
  verb->add_option("-o,--output", o->output, "The run file to write, RUN.h5")->required();
  verb->add_option("--set", o->sets, "Override a key, such as --set mill.speed=0.8; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->add_flag("--resume", o->resume, "Go on with an interrupted run (RUN.h5.part)");
  add_common(*verb, *o);
  verb->footer("Example: tumble simulate examples/lab_mill_55cm.toml --set mill.speed=0.8 -o run.h5");
  verb->callback([o] { simulate(*o); });
}

}  // namespace tumble::cli
