#include <cmath>
#include <memory>

#include "cli/film_input.h"
#include "cli/options.h"
#include "cli/steps.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "io/film_file.h"
#include "io/image_file.h"
#include "io/motion_file.h"
#include "io/output.h"

namespace tumble::cli {
namespace {

struct Options : CommonOptions {
  fs::path input, output, csv, overlay, sheet;
  std::string centre;
  FilmInput film;
};

void analyse(Options o) {
  limit_threads(o.threads);
  settle(o.film);
  analysis::TracksOptions& film = o.film.told;
  if (!o.centre.empty()) parse_point(o.centre, "--centre-px", film.centre_u_px, film.centre_v_px);
  if (!std::isnan(film.metres_per_pixel) && !(film.metres_per_pixel > 0))
    throw InputError("--metres-per-pixel", "must be a positive number of metres");
  io::check_not_input(o.output, o.input);
  if (o.film.drawing) io::check_not_input(o.output, o.film.mill);
  io::check_output_file(o.output, o.force);
  if (!o.csv.empty()) {
    io::make_output_folder(o.csv);
    for (const char* table : io::kTables) io::check_output_file(o.csv / table, o.force);
  }

  std::unique_ptr<io::FilmWriter> overlay;
  if (!o.overlay.empty()) {
    io::check_not_input(o.overlay, o.input);
    io::check_output_file(o.overlay, o.force);
    film.overlay = [&](const Image& picture) {
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
    film.sheet = [&](const Image& picture) { io::write_png(o.sheet.string(), picture); };
  }
  const ChargeMotion motion = measure(o.input, film, o);
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
  verb->add_option("--csv", o->csv, "Folder for summary.json, profile.csv, tracks.csv, occupancy.csv");
  verb->add_option("--overlay", o->overlay, "FILM.mp4 to write: the film with all that was found drawn over it");
  verb->add_option("--sheet", o->sheet, "Contact sheet to write, PNG; of films with --csv, sheet.png there");
  add_film_input(*verb, o->film);
  verb->add_option("--centre-px", o->centre,
                   "u,v of the mill's axis in TRACKS.csv; not given: by the balls it carries");
  verb->add_option("--metres-per-pixel", o->film.told.metres_per_pixel,
                   "Scale of TRACKS.csv; not given: by the mill's diameter, else by the balls' radii");
  add_common(*verb, *o);
  verb->footer("Example: tumble analyse film.mp4 --mill mill.toml -o motion.h5 --csv results");
  verb->callback([o] { analyse(*o); });
}

}  // namespace tumble::cli
