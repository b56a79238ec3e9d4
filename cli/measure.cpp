#include <cstring>
#include <fstream>

#include "cli/steps.h"
#include "core/error.h"
#include "io/tracks_file.h"

namespace tumble::cli {
namespace {

// HDF5's signature: a run file, even one cut short, is to be refused as a run file and not as a film.
bool looks_like_hdf5(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  return file.read(head, sizeof head) && std::memcmp(head, "\x89HDF\r\n\x1a\n", sizeof head) == 0;
}

}  // namespace

ChargeMotion measure(const fs::path& input, const analysis::TracksOptions& film, const CommonOptions& options) {
  std::error_code error;
  if (!fs::exists(input, error))
    throw InputError(input.string(), "does not exist; give a film, a folder or a run file");
  ChargeMotion motion;
  if (looks_like_hdf5(input)) {
    motion = measure_run(io::RunReader(input), options);
  } else if (input.extension() == ".csv") {
    motion = analysis::measure_tracks(io::read_pixel_tracks(input), film);
  } else {
    ProgressLine line(options, "reading the film", "nothing was written");
    motion = analysis::are_stills(input.string()) ? analysis::measure_stills(input.string(), film, line.callback())
                                                  : analysis::measure_film(input.string(), film, line.callback());
  }
  motion.origin = input.string();
  return motion;
}

}  // namespace tumble::cli
