#pragma once
#include <string>

#include "core/run_summary.h"
#include "io/run_file.h"

namespace tumble::cli {

RunSummary summarise(const io::RunReader& run);
std::string to_json(const RunSummary& summary, const io::RunReader& run);

}  // namespace tumble::cli
