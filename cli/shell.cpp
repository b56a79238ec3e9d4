#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/verbs.h"
#include "core/lifter_check.h"
#include "core/mill_shape.h"
#include "io/config_file.h"
#include "io/output.h"
#include "io/shell_file.h"

namespace tumble::cli {
namespace {

namespace fs = std::filesystem;

struct Options : CommonOptions {
  fs::path config, output;
  std::vector<std::string> sets;
  double chord = kNotGiven;
};

std::string summary_of(const Config& config) {
  const MillShape shape = make_mill_shape(config);
  const auto points = outline(shape, shape.radius / 1000);
  double twice = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  const nlohmann::ordered_json summary{{"diameter_m", config.mill.diameter},
                                       {"profile", name_of(config.mill.lifters.profile)},
                                       {"lifters", shape.lifter_count},
                                       {"tip_radius_m", shape.tip_radius},
                                       {"free_area_m2", twice / 2}};
  return summary.dump(2) + "\n";
}

void shell(const Options& o) {
  const bool svg = o.output.extension() == ".svg";
  if (!svg && o.output.extension() != ".csv")
    throw InputError(o.output.string(), "is neither a drawing nor a table; give SHELL.svg or SHELL.csv");
  const Config config = io::read_config(o.config, o.sets);
  if (std::isnan(config.mill.diameter))
    throw InputError(place_of(config, "mill.diameter"), "is missing; give the diameter inside the shell in m");
  check_lifters_complete(config);
  const double finest = config.mill.diameter * 1e-6;
  if (o.chord < finest || std::isinf(o.chord))
    throw InputError("--chord", "must be a length in m, at least a millionth of the diameter");
  io::check_not_input(o.output, o.config);
  io::check_output_file(o.output, o.force);
  const double chord = std::isnan(o.chord) ? config.mill.diameter / 400 : o.chord;
  (svg ? io::write_shell_svg : io::write_shell_csv)(o.output, config, chord);
  if (o.json) print(summary_of(config));
}

}  // namespace

void add_shell(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("shell", "Draw the shell with its lifters, or list its outline");
  verb->add_option("config", o->config, "MILL.toml; what it says beside [mill] may be missing")->required();
  verb->add_option("-o,--output", o->output, "The drawing or the table to write, SHELL.svg or SHELL.csv")->required();
  verb->add_option("--set", o->sets,
                   "Override a key, such as --set effects.lifter_wear.height_loss=0.3; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb->add_option("--chord", o->chord, "Longest chord of the shell's arcs in m (default: diameter / 400)");
  add_common(*verb, *o);
  verb->footer("Example: tumble shell examples/lab_mill_55cm.toml -o shell.svg");
  verb->callback([o] { shell(*o); });
}

}  // namespace tumble::cli
