#pragma once
#include <string>

#include "core/calibration.h"
#include "io/plot_page.h"

namespace tumble::io {

// calibration.json: docs/calibration.md.
std::string calibration_json(const Calibration& calibration);

// runs.csv: a row per run of the fit: experiment, the fitted keys, seed, then as in the table of a sweep.
std::string runs_csv(const Calibration& calibration);

// The report: parameters with errors and correlations, measured against predicted.
PlotPage calibration_page(const Calibration& calibration);

// `definition` in the text of a calibration.json; empty where there is none to be read.
std::string definition_in(const std::string& calibration_json);

}  // namespace tumble::io
