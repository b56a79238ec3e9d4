#include "cli/film_input.h"

#include <cmath>
#include <map>

#include "cli/options.h"
#include "io/config_file.h"

namespace tumble::cli {

void add_film_input(CLI::App& verb, FilmInput& input) {
  verb.add_option("--mill", input.mill, "MILL.toml with what is known of the mill; may be partial");
  verb.add_option("--recorded-fps", input.told.recorded_fps, "The camera's rate where the file's is another, 1/s");
  verb.add_option("--rotation", input.rotation, "How the mill turns in a film: auto, clockwise, counter_clockwise")
      ->capture_default_str();
}

void settle(FilmInput& input) {
  static const std::map<std::string, Rotation> rotations = {{"auto", Rotation::kUnknown},
                                                            {"clockwise", Rotation::kClockwise},
                                                            {"counter_clockwise", Rotation::kCounterClockwise}};
  input.told.rotation = parse_name(input.rotation, "--rotation", rotations);
  if (!std::isnan(input.told.recorded_fps) && !(input.told.recorded_fps > 0))
    throw InputError("--recorded-fps", "must be a positive number of frames per second");
  if (!input.mill.empty()) input.drawing = io::read_config(input.mill);
  input.told.mill = input.drawing ? &*input.drawing : nullptr;
}

}  // namespace tumble::cli
