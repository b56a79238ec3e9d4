#pragma once
#include <filesystem>
#include <string>

#include "cli/steps.h"
#include "core/charge_motion.h"
#include "io/run_file.h"

namespace tumble::cli {

// A small film of what was measured beside two runs of its mill: as the model was, and (null: nothing was) with what
// was found. All begin with the lifters in the same place where that is known, and keep step. `measured`: the film or
// stills file that `motion` was found in. Writes `output`, an .mp4, and returns it with a caption; the path is empty
// where they have no stretch of time in common.
struct DiagnosisFilmFile {
  fs::path file;
  std::string caption;
};
DiagnosisFilmFile make_diagnosis_film(const fs::path& measured, const ChargeMotion& motion, const io::RunReader& before,
                                      const io::RunReader* after, const fs::path& output, const CommonOptions& options);

}  // namespace tumble::cli
