#pragma once
#include <filesystem>
#include <vector>

namespace tumble::io {

// What a torque meter wrote: the whole mill's.
struct TorqueSeries {
  std::vector<double> time;    // [s], grows
  std::vector<double> torque;  // [N m]
};

// A CSV table with the columns time_s and torque_N_m, and maybe power_W, which is not read. Throws InputError with
// file, line and column.
TorqueSeries read_torque_series(const std::filesystem::path& path);

}  // namespace tumble::io
