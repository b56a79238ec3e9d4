#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/sweep.h"
#include "io/run_columns.h"

namespace tumble::io {

// SWEEP.h5 and the table of --csv: docs/campaigns.md. Nothing in them depends on when or on how many threads they were
// made. Throw WorkError where they cannot be written.
void write_sweep(const std::filesystem::path& path, const Sweep& sweep);
void write_sweep_csv(const std::filesystem::path& path, const Sweep& sweep);

// What a sweep is before it runs, as text: the mill, the varied keys with their values, seed, repeats, and the
// program's version. Of a file: throws InputError where it is no sweep.
std::string definition_of(const Sweep& sweep);
std::string read_sweep_definition(const std::filesystem::path& path);

// The runs of a complete sweep, read back, without the standard errors of speed and filling, which no table has. Throws
// InputError where the file does not hold the sweep's runs.
std::vector<RunOutcome> read_sweep_runs(const std::filesystem::path& path, const Sweep& definition);

// A quantity at a point: its repeats that did not fail, and their mean with the standard error of that mean.
std::vector<Estimate> at_point(const Sweep& sweep, std::size_t point, const RunQuantity& quantity);
Estimate over_repeats(const Sweep& sweep, std::size_t point, const RunQuantity& quantity);

// A value of a varied key as a number; NaN where it is a name.
double number_of(const std::string& value);

}  // namespace tumble::io
