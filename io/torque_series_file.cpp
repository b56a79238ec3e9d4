#include "io/torque_series_file.h"

#include <fmt/format.h>

#include <string>

#include "core/error.h"
#include "io/csv_file.h"

namespace tumble::io {

TorqueSeries read_torque_series(const std::filesystem::path& path) {
  const CsvTable table = read_csv(path);
  table.check_columns(std::vector<std::string>{"time_s", "torque_N_m", "power_W"});
  TorqueSeries series{table.numbers("time_s"), table.numbers("torque_N_m")};
  for (std::size_t i = 1; i < series.time.size(); ++i)
    if (!(series.time[i] > series.time[i - 1]))
      throw InputError(table.place(i, "time_s"),
                       fmt::format("time_s is {} after {}; times must grow", series.time[i], series.time[i - 1]));
  return series;
}

}  // namespace tumble::io
