#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string_view>

#include "cli/options.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/sweep_file.h"
#include "trials/make.h"
#include "trials/verbs.h"

namespace tumble::trials {
namespace fs = std::filesystem;
namespace {

// The one-layer mill of examples/slice_mill_55cm.toml, with the friction of the 1992 paper's Table 3.
constexpr std::string_view kUsualMill = R"([mill]
diameter = 0.55
length = 0.0235
speed = 0.7
critical_speed_rpm = 58.3
[mill.lifters]
count = 12
profile = "rectangle"
height = 0.022
width = 0.022
[charge]
count = 169
balls = [ { radius = 0.011, density = 7800, share = 1.0 } ]
[contact]
law = "linear"
normal_stiffness = 4e5
tangential_stiffness = 3e5
friction = 0.2
restitution = 0.8
[contact.wall]
restitution = 0.4
[run]
spin_up = 2.0
)";

// Standard deviations of what is uncertain unless told otherwise; of the stiffness a share.
constexpr struct {
  const char* key;
  double sd;
} kUsuallyUncertain[] = {{"contact.friction", 0.03}, {"contact.restitution", 0.04}, {"contact.wall.restitution", 0.07}};
constexpr double kStiffnessShare = 0.3;

struct Options : cli::CommonOptions {
  fs::path data, keys, mill;
  std::vector<std::string> sets, kinds, uncertain;
  std::string tier = "tracks", size = "720x720";
  std::size_t n = 0;
  std::vector<std::string> speeds{"0.5", "0.7", "0.9"}, hold_out_speeds{"0.8"}, hold_out_fillings{"0.3"};
  double revolutions = 8, fps = 250, place_mm = 0.3, angle_deg = 0.5;
  double torque_noise = LabPlan().torque_noise, torque_error = LabPlan().torque_error;
  std::optional<std::uint64_t> seed;
  bool resume = false;
};

void check_range(double value, const char* option, double least, double most, const char* unit) {
  if (!(value >= least && value <= most))
    throw InputError(option, fmt::format("is {:g}; give {:g} to {:g} {}", value, least, most, unit));
}

std::vector<double> numbers_of(const std::vector<std::string>& list, const char* option) {
  std::vector<double> numbers;
  if (list == std::vector<std::string>{"none"}) return numbers;
  for (const std::string& text : list) {
    numbers.push_back(io::number_of(text));
    if (!(numbers.back() > 0))
      throw InputError(option, "is \"" + text + "\"; give numbers above 0, with commas, or none");
  }
  return numbers;
}

std::vector<UncertainKey> uncertain_of(const Options& o, const Config& mill) {
  std::vector<UncertainKey> list;
  for (const std::string& text : o.uncertain) {
    const auto equals = text.find('=');
    const double sd = equals == std::string::npos ? kNotGiven : io::number_of(text.substr(equals + 1));
    if (!(sd > 0)) throw InputError("--uncertain", "is \"" + text + "\"; give KEY=SD, such as contact.friction=0.05");
    list.push_back({text.substr(0, equals), sd, "--uncertain"});
  }
  if (!list.empty()) return list;
  for (const auto& [key, sd] : kUsuallyUncertain)
    if (!std::isnan(io::number_at(mill, key))) list.push_back({key, sd, ""});
  list.push_back({"contact.normal_stiffness", kStiffnessShare * mill.contact.normal_stiffness, ""});
  return list;
}

MakePlan plan_of(const Options& o) {
  MakePlan plan;
  plan.data = o.data;
  plan.keys = o.keys;
  if (o.keys.empty()) {
    fs::path beside = o.data;
    if (!beside.has_filename()) beside = beside.parent_path();  // "DIR/"
    plan.keys = beside += "-keys";
  }
  LabPlan& lab = plan.lab;
  lab.mill = o.mill.empty() ? io::parse_config(std::string(kUsualMill), "the usual mill", o.sets)
                            : io::read_config(o.mill, o.sets);
  check_range(o.revolutions, "--revolutions", 0.01, 1000, "revolutions");
  check_range(o.fps, "--fps", 10, 10000, "frames per second");
  check_range(o.place_mm, "--noise-mm", 0, 100, "mm");
  check_range(o.angle_deg, "--angle-noise-deg", 0, 90, "degrees");
  check_range(o.torque_noise, "--torque-noise", 0, 1, "of M g R");
  check_range(o.torque_error, "--torque-error", 1e-6, 1, "of M g R");
  lab.mill.run.revolutions = o.revolutions;
  lab.mill.run.frames_per_second = o.fps;
  check_complete(lab.mill);
  lab.conditions =
      conditions_of(lab.mill, {numbers_of(o.speeds, "--speeds"), numbers_of(o.hold_out_speeds, "--hold-out-speeds"),
                               numbers_of(o.hold_out_fillings, "--hold-out-fillings")});
  lab.uncertain = uncertain_of(o, lab.mill);
  lab.tracking.place = o.place_mm / 1000;
  lab.tracking.angle = radians(o.angle_deg);
  lab.torque_noise = o.torque_noise;
  lab.torque_error = o.torque_error;
  cli::parse_size(o.size, "--size", lab.width, lab.height);

  plan.draw.mill = lab.mill;
  plan.draw.uncertain = lab.uncertain;
  plan.draw.tier = tier_named(o.tier);
  plan.draw.n = o.n;
  for (const std::string& kind : o.kinds) plan.draw.kinds.push_back(kind_named(kind));
  return plan;
}

void run(const Options& o) {
  limit_threads(o.threads);
  const MakePlan plan = plan_of(o);
  std::random_device device;
  Random told(o.seed.value_or(0));
  const auto entropy = [&]() -> std::uint64_t {
    if (o.seed) return told.next();
    return std::uint64_t{device()} << 32 | device();
  };
  cli::ProgressLine line(o, "making trials", "finished trials are kept; go on with: tumble trials make ... --resume");
  const IfThere if_there = o.resume ? IfThere::kResume : o.force ? IfThere::kReplace : IfThere::kRefuse;
  make_trials(plan, entropy, if_there, line.callback());
  if (o.json)
    cli::print(nlohmann::ordered_json{{"trials", plan.draw.n},
                                      {"data", plan.data.string()},
                                      {"keys", plan.keys.string()},
                                      {"experiments", plan.lab.conditions.size()}}
                   .dump(2) +
               "\n");
}

}  // namespace

void add_make(CLI::App& trials) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = trials.add_subcommand("make", "Write blind data sets, their keys, and the seals of the keys");
  const auto repeatable = [](CLI::Option* option) {
    return option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  verb->add_option("-o,--output", o->data, "Folder for the data and seals.txt; each trial is a folder 0001 ... in it")
      ->required();
  verb->add_option("--n", o->n, "Number of trials")->required()->check(CLI::Range(1, 9999));
  verb->add_option("--kind", o->kinds,
                   "What may hide: single, hard, none, artefact, physics, pair, unknown or turn_locked; several with "
                   "commas, each equally often")
      ->required()
      ->delimiter(',');
  verb->add_option("--data", o->tier,
                   "tracks (balls followed, torque), films (rendered, torque) or scalars (mean torque, toe, shoulder)")
      ->capture_default_str();
  verb->add_option("--keys", o->keys, "Folder for the keys [DIR-keys beside DIR]");
  verb->add_option("--mill", o->mill, "MILL.toml [the one-layer mill of 0.55 m]");
  repeatable(verb->add_option("--set", o->sets, "Override a key of the mill, such as --set run.spin_up=4"));
  verb->add_option("--speeds", o->speeds, "Experiments to fit by, fractions of critical")
      ->delimiter(',')
      ->capture_default_str();
  verb->add_option("--hold-out-speeds", o->hold_out_speeds, "Experiments that are held out; or none")
      ->delimiter(',')
      ->capture_default_str();
  verb->add_option("--hold-out-fillings", o->hold_out_fillings, "The same, at the mill's own speed; or none")
      ->delimiter(',')
      ->capture_default_str();
  repeatable(verb->add_option("--uncertain", o->uncertain,
                              "KEY=SD of what MILL.toml does not know exactly; the truth is off by up to twice that "
                              "[friction 0.03, restitution 0.04 and at the wall 0.07, stiffness 30 %]"));
  verb->add_option("--revolutions", o->revolutions, "Of each experiment, as the mill is believed to turn")
      ->capture_default_str();
  verb->add_option("--fps", o->fps, "Frames per second of camera and torque sensor")->capture_default_str();
  verb->add_option("--noise-mm", o->place_mm, "Noise of a ball's place, x and y")->capture_default_str();
  verb->add_option("--angle-noise-deg", o->angle_deg, "Noise of a ball's mark, of whose angles spins are made")
      ->capture_default_str();
  verb->add_option("--torque-noise", o->torque_noise, "Noise of a torque reading, in M g R of the charge")
      ->capture_default_str();
  verb->add_option("--torque-error", o->torque_error, "What all readings of an experiment share, likewise")
      ->capture_default_str();
  verb->add_option("--size", o->size, "Of films, in pixels")->capture_default_str();
  verb->add_option("--seed", o->seed, "Not by chance but by this number: for tests; whoever knows it knows the keys");
  verb->add_flag("--resume", o->resume, "Go on with trials that were interrupted");
  cli::add_common(*verb, *o);
  verb->footer("Example: tumble trials make -o trials --n 100 --kind single,none,unknown");
  verb->callback([o] { run(*o); });
}

}  // namespace tumble::trials
