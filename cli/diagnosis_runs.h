#pragma once
#include <filesystem>
#include <vector>

#include "cli/console.h"
#include "core/diagnosis.h"
#include "diagnose/measurement.h"
#include "io/diagnosis_file.h"

namespace tumble::cli {

// Short runs of every experiment's mill, in DIR/runs: EXPERIMENT-before.h5 of the model as it was with its uncertain
// keys refitted, EXPERIMENT-after.h5 of model.toml, or of model_tabulated.toml where that is what was found. They are
// written into DIR/runs.part, which is gone with its owner unless keep() was called.
class DiagnosisRuns {
 public:
  // Throws InputError where DIR/runs is there and may not be replaced.
  static void check(const std::filesystem::path& folder, bool force);

  // `diagnosis` and `measurements` outlive this.
  DiagnosisRuns(const std::filesystem::path& folder, const Diagnosis& diagnosis,
                const std::vector<diagnose::Measurement>& measurements, const CommonOptions& options);
  ~DiagnosisRuns();
  DiagnosisRuns(const DiagnosisRuns&) = delete;
  DiagnosisRuns& operator=(const DiagnosisRuns&) = delete;

  // Of the experiments that brought a torque series and the mill's angle: torque over a lifter's passage.
  std::vector<TorqueCurve> torque() const;
  // The first fitted film beside its mill before and after, written into `file`; nothing where there is no film.
  std::vector<io::DiagnosisFilm> film(const std::filesystem::path& file) const;
  // Now they are DIR/runs.
  void keep();

 private:
  struct Pair {
    const diagnose::Measurement* measurement = nullptr;
    std::filesystem::path before, after;  // no `after` where nothing was added
    double torque_offset = 0;             // of the instrument, by what was found [N m of one slice]
    double clock = 1;                     // seconds of the frames in one of the torque series, likewise
  };

  std::filesystem::path folder_;
  const CommonOptions& options_;
  std::vector<Pair> pairs_;
};

}  // namespace tumble::cli
