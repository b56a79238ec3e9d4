#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/checkpoint.h"
#include "core/frame.h"

// RUN.h5: HDF5 in H5MD 1.1 layout; docs/run-file.md.
namespace tumble::io {

// Writes RUN.h5.part beside the final name and renames it in finish(). Destroyed unfinished it leaves the .part,
// readable up to the last whole frame.
class RunWriter {
 public:
  // `checkpoint_words`: space set aside for checkpoints.
  RunWriter(const std::filesystem::path& path, const RunSetup& setup, std::size_t checkpoint_words);
  // Goes on with an interrupted run from its last checkpoint: frames after it are dropped.
  static RunWriter resume(const std::filesystem::path& path, const RunSetup& setup);
  ~RunWriter();
  RunWriter(RunWriter&&) noexcept;

  void write(const Frame& frame);
  void write(const Checkpoint& checkpoint);
  void finish(const RunResult& result);

 private:
  struct Impl;
  explicit RunWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// The newest checkpoint of the interrupted run beside `path`, if there is one. Throws InputError where that run has
// another config or was written by another version.
std::optional<StoredCheckpoint> read_checkpoint(const std::filesystem::path& path, const Config& config);

// A run that was interrupted between its last frame and its final name: gives it that name. False where there is none.
bool adopt_complete_run(const std::filesystem::path& path, const Config& config);

class RunReader {
 public:
  explicit RunReader(
      const std::filesystem::path& path);  // throws InputError: not there, not HDF5, not a run, truncated
  ~RunReader();
  RunReader(RunReader&&) noexcept;

  const RunSetup& setup() const;
  std::size_t frame_count() const;  // whole frames in the file
  Frame frame(std::size_t index) const;
  Observables observables(std::size_t index) const;  // of that frame, without reading its balls
  const std::vector<double>& time() const;           // [s]
  const std::vector<double>& torque() const;         // [N m], of one slice
  const RunResult& result() const;                   // defaults where the run was interrupted
  bool complete() const;
  std::string version() const;  // of the program that wrote it

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

bool is_run_file(const std::filesystem::path& path);  // an HDF5 file with the H5MD group and our balls

}  // namespace tumble::io
