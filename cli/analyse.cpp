#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "cli/options.h"
#include "cli/steps.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "io/config_file.h"
#include "io/film_file.h"
#include "io/image_file.h"
#include "io/motion_file.h"
#include "io/output.h"

namespace tumble::cli {
namespace {

const std::map<std::string, Rotation> kRotations = {{"auto", Rotation::kUnknown},
                                                    {"clockwise", Rotation::kClockwise},
                                                    {"counter_clockwise", Rotation::kCounterClockwise}};

struct Options : CommonOptions {
  fs::path input, output, mill, csv, overlay, sheet;
  std::string rotation = "auto";
  std::string centre;
  analysis::TracksOptions film;
};

void analyse(Options o) {
  limit_threads(o.threads);
  o.film.rotation = parse_name(o.rotation, "--rotation", kRotations);
  std::optional<Config> mill;
  if (!o.mill.empty()) mill = io::read_config(o.mill);
  o.film.mill = mill ? &*mill : nullptr;
  if (!std::isnan(o.film.recorded_fps) && !(o.film.recorded_fps > 0))
    throw InputError("--recorded-fps", "must be a positive number of frames per second");
  if (!o.centre.empty()) parse_point(o.centre, "--centre-px", o.film.centre_u_px, o.film.centre_v_px);
  if (!std::isnan(o.film.metres_per_pixel) && !(o.film.metres_per_pixel > 0))
    throw InputError("--metres-per-pixel", "must be a positive number of metres");
  io::check_not_input(o.output, o.input);
  if (mill) io::check_not_input(o.output, o.mill);
  io::check_output_file(o.output, o.force);
  if (!o.csv.empty()) {
    io::make_output_folder(o.csv);
    for (const char* table : io::kTables) io::check_output_file(o.csv / table, o.force);
  }

  std::unique_ptr<io::FilmWriter> overlay;
  if (!o.overlay.empty()) {
    io::check_not_input(o.overlay, o.input);
    io::check_output_file(o.overlay, o.force);
    o.film.overlay = [&](const Image& picture) {
      if (overlay == nullptr) {
        io::FilmFormat format;
        format.width = picture.width;
        format.height = picture.height;
        format.fps_numerator = 30;
        overlay = std::make_unique<io::FilmWriter>(o.overlay.string(), format);
      }
      overlay->write(picture);
    };
  }
  if (o.sheet.empty() && !o.csv.empty()) o.sheet = o.csv / "sheet.png";
  if (!o.sheet.empty()) {
    io::check_not_input(o.sheet, o.input);
    io::check_output_file(o.sheet, o.force);
    o.film.sheet = [&](const Image& picture) { io::write_png(o.sheet.string(), picture); };
  }
  const ChargeMotion motion = measure(o.input, o.film, o);
  if (overlay != nullptr) overlay->finish();
  for (const std::string& caveat : motion.caveats) say(o, "note: " + caveat);
  io::write_motion(o.output, motion);
  if (!o.csv.empty()) io::write_csv(o.csv, motion);
  if (o.json) print(io::summary_json(motion));
}

}  // namespace

void add_analyse(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("analyse", "Extract the charge's motion from a film, stills, tracks or a run file");
  verb->add_option("input", o->input,
                   "Film, folder of stills, TRACKS.csv (track,frame,x_px,y_px,r_px), or RUN.h5 (truth)")
      ->required();
  verb->add_option("-o,--output", o->output, "MOTION.h5 to write")->required();
  verb->add_option("--mill", o->mill, "MILL.toml with what is known of the mill; may be partial");
  verb->add_option("--csv", o->csv, "Folder for summary.json, profile.csv, tracks.csv, occupancy.csv");
  verb->add_option("--overlay", o->overlay, "FILM.mp4 to write: the film with all that was found drawn over it");
  verb->add_option("--sheet", o->sheet, "Contact sheet to write, PNG; of films with --csv, sheet.png there");
  verb->add_option("--recorded-fps", o->film.recorded_fps, "The camera's rate where the file's is another, 1/s");
  verb->add_option("--rotation", o->rotation, "How the mill turns in the film: auto, clockwise, counter_clockwise")
      ->capture_default_str();
  verb->add_option("--centre-px", o->centre,
                   "u,v of the mill's axis in TRACKS.csv; not given: by the balls it carries");
  verb->add_option("--metres-per-pixel", o->film.metres_per_pixel,
                   "Scale of TRACKS.csv; not given: by the mill's diameter, else by the balls' radii");
  add_common(*verb, *o);
  verb->footer("Example: tumble analyse film.mp4 --mill mill.toml -o motion.h5 --csv results");
  verb->callback([o] { analyse(*o); });
}

}  // namespace tumble::cli
