// Films and pictures of mills as a camera in a laboratory takes them, with the exact truth: to train and to try the
// analyser of films.
//   make_films pictures --count N --seed S --out DIR [--level 0..3] [--mills 40] [--mill-seed M]
//   make_films film --seed S --level L --seconds T --fps F --out FILM.mp4
//   make_films mean --seed S --level L --seconds T --fps F --times 8 --out MEAN.json
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "bench/film_commands.h"
#include "core/error.h"

using namespace tumble;

int main(int argc, char** argv) try {
  CLI::App app{"Films and pictures of mills as a camera takes them, with the truth"};
  app.require_subcommand(1);

  films::PictureOrder pictures;
  CLI::App* stills = app.add_subcommand("pictures", "Independent pictures, each of another mill, light and camera");
  stills->add_option("--count", pictures.count, "How many")->capture_default_str();
  stills->add_option("--seed", pictures.seed, "Of everything")->capture_default_str();
  stills->add_option("--out", pictures.folder, "Folder")->required();
  stills->add_option("--level", pictures.level, "0 clean to 3 nasty; any if not given");
  stills->add_option("--mills", pictures.mills, "Mills to simulate")->capture_default_str();
  stills->add_option("--mill-seed", pictures.mill_seed, "Of the mills, to share them between calls; else --seed");
  stills->callback([&] { films::make_pictures(pictures); });

  films::FilmOrder film;
  const auto add_order = [&](CLI::App* to) {
    to->add_option("--seed", film.seed, "Of everything")->capture_default_str();
    to->add_option("--level", film.level, "0 clean to 3 nasty")->capture_default_str();
    to->add_option("--seconds", film.seconds, "Of the mill's time")->capture_default_str();
    to->add_option("--fps", film.fps, "Frames per second as recorded")->capture_default_str();
    to->add_option("--out", film.file, "FILM.mp4, or the JSON file")->required();
  };
  CLI::App* moving = app.add_subcommand("film", "One film, its truth, and what a laboratory would know of the mill");
  add_order(moving);
  moving->callback([&] { films::make_film(film); });

  double times = 8;
  CLI::App* mean =
      app.add_subcommand("mean", "What the mill of such a film does in the long run, without any pictures");
  add_order(mean);
  mean->add_option("--times", times, "As long as the film")->capture_default_str();
  mean->callback([&] { films::make_long_run(film, times); });

  CLI11_PARSE(app, argc, argv);
  return 0;
} catch (const Error& e) {
  fmt::print(stderr, "make_films: {}\n", e.what());
  return static_cast<int>(e.kind());
}
