#include "cli/simulation.h"

#include <memory>
#include <optional>
#include <utility>

#include "io/run_file.h"
#include "sim/simulator.h"

namespace tumble::cli {

RunResult write_run(const Config& config, const std::filesystem::path& output, bool resume, const Progress& progress) {
  std::optional<StoredCheckpoint> checkpoint;
  if (resume) checkpoint = io::read_checkpoint(output, config);
  const bool resumed = checkpoint.has_value();
  std::unique_ptr<io::RunWriter> writer;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& setup) {
    writer =
        std::make_unique<io::RunWriter>(resumed ? io::RunWriter::resume(output, setup)
                                                : io::RunWriter(output, setup, sim::checkpoint_capacity(setup.config)));
  };
  sink.frame = [&](const Frame& frame) { writer->write(frame); };
  sink.checkpoint = [&](const Checkpoint& c) { writer->write(c); };
  sink.progress = progress;
  const RunResult result = sim::simulate(config, sink, std::move(checkpoint));
  writer->finish(result);
  return result;
}

void simulate_to_file(const Config& config, const std::filesystem::path& output, bool resume,
                      const CommonOptions& options) {
  ProgressLine line(options, "simulating",
                    "the run so far is kept; go on with: tumble simulate ... -o " + output.string() + " --resume");
  const RunResult result = write_run(config, output, resume, line.callback());
  if (!result.caveat.empty()) say(options, "note: " + result.caveat);
}

}  // namespace tumble::cli
