#include "io/config_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "core/random.h"
#include "io/config_keys.h"

namespace tumble::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

// The example of docs/mill-file.md.
const std::string kMill = R"([mill]
diameter = 0.545
length = 0.304
speed = 0.7
[mill.lifters]
count = 18
profile = "rectangle"
height = 0.02
width = 0.02
[charge]
filling = 0.385
balls = [ { radius = 0.012, mass = 0.060, share = 0.7 }, { radius = 0.018, mass = 0.195, share = 0.2 },
          { radius = 0.025, mass = 0.525, share = 0.1 } ]
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
revolutions = 6
frames_per_second = 200
time_step = "auto"
seed = 1
)";

std::string message_of(const std::string& toml, const std::vector<std::string>& sets = {}) {
  try {
    parse_config(toml, "mill.toml", sets);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(ConfigFile, ReadsEveryPartOfTheFormat) {
  const Config c = parse_config(kMill, "mill.toml");
  EXPECT_EQ(c.mill.diameter, 0.545);
  EXPECT_EQ(c.mill.lifters.count, 18);
  EXPECT_EQ(c.mill.lifters.profile, LifterProfile::kRectangle);
  EXPECT_EQ(c.charge.filling, 0.385);
  EXPECT_FALSE(c.charge.count);
  ASSERT_EQ(c.charge.balls.size(), 3u);
  EXPECT_EQ(c.charge.balls[1].mass, 0.195);
  EXPECT_EQ(c.contact.wall.restitution, 0.4);
  EXPECT_TRUE(std::isnan(c.contact.wall.friction));
  EXPECT_EQ(c.run.revolutions, 6.0);
  EXPECT_TRUE(std::isnan(c.run.time_step));
  EXPECT_EQ(place_of(c, "mill.diameter"), "mill.toml:2: mill.diameter");
  EXPECT_EQ(place_of(c, "mill.slices"), "mill.toml: mill.slices");
}

TEST(ConfigFile, TheDocsNameEveryKey) {
  std::ifstream in(std::filesystem::path(TUMBLE_SOURCE_DIR) / "docs/mill-file.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  for (const Key& key : config_keys()) EXPECT_THAT(page, HasSubstr("`" + key.path + "`"));
}

TEST(ConfigFile, NamesPlaceFindingAndRemedy) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"[mill]\ndiamter = 1", "mill.toml:2: mill.diamter: unknown key; did you mean mill.diameter?"},
      {"diameter = 1", "mill.toml:1: diameter: unknown key; did you mean mill.diameter?"},
      {"[charge]\nfriction = 0.2", "mill.toml:2: charge.friction: unknown key; did you mean contact.friction?"},
      {"[mil]\nx = 1", "mill.toml:1: mil: unknown table; did you mean [mill]?"},
      {"mill = 3", "mill.toml:1: mill: found 3, must be a table: [mill]"},
      {"[mill]\n\ndiameter = \"big\"",
       "mill.toml:3: mill.diameter: found the string \"big\", must be a length in m, > 0"},
      {"[mill]\ndiameter = nan", "mill.toml:2: mill.diameter: found nan, must be a length in m, > 0"},
      {"[mill]\nspeed = inf", "mill.toml:2: mill.speed: found inf, must be a fraction of critical speed, >= 0"},
      {"[charge]\ncount = 1.5", "mill.toml:2: charge.count: found 1.5, must be a whole number, >= 1"},
      {"[charge]\ncount = 99999999999", "mill.toml:2: charge.count: found 99999999999, must be a whole number, >= 1"},
      {"[run]\nseed = -1", "mill.toml:2: run.seed: found -1, must be a whole number from 0 to 9223372036854775807"},
      {"[run]\nspin_up = \"atuo\"",
       "mill.toml:2: run.spin_up: found the string \"atuo\", must be revolutions, >= 0, or \"auto\""},
      {"[mill]\nspeed = 0.7\nspeed_rpm = 40",
       "mill.toml:3: mill.speed_rpm: given beside mill.speed; keep one of the two"},
      {"[charge]\ncount = 7\nfilling = 0.3",
       "mill.toml:3: charge.filling: given beside charge.count; keep one of the two"},
      {"[mill.lifters]\nprofile = \"rectangel\"",
       "mill.toml:2: mill.lifters.profile: found the string \"rectangel\", did you mean \"rectangle\"? available: "
       "none, rectangle, triangle, trapezoid"},
      {"[mill.lifters]\nprofile = \"waves\"",
       "mill.toml:2: mill.lifters.profile: found the string \"waves\", did you mean \"wave\"?"},
      {"[effects.rolling_resistence]\ncoefficient = 0.05",
       "mill.toml:1: effects.rolling_resistence: no such effect; did you mean rolling_resistance?"},
      {"[effects.rolling_resistance]\ncoeficient = 0.05",
       "mill.toml:2: effects.rolling_resistance.coeficient: unknown key; did you mean coefficient?"},
      {"[effects.missing_lifters]\nlifters = 3",
       "mill.toml:2: effects.missing_lifters.lifters: found 3, must be a list of lifter numbers"},
      {"[mill.lifters]\npoints = [ [0, 1, 2] ]",
       "mill.toml:2: mill.lifters.points[0]: found a list, must be [height, across]"},
      {"[charge]\nballs = [ { radius = 0.01, mass = 1, density = 7800 } ]",
       "mill.toml:2: charge.balls[0].density: given beside mass; keep one of the two"},
      {"[charge]\nballs = [ { radius = 0.01, mass = 1 },\n { radius = 0.01, sharre = 1 } ]",
       "mill.toml:3: charge.balls[1].sharre: unknown key; did you mean share? known: radius, mass, density, share"},
      {"[charge]\nballs = []",
       "mill.toml:2: charge.balls: found a list, must be a list of ball classes, [ { radius = "
       "0.012, mass = 0.060, share = 0.7 }, ... ]"},
  };
  for (const auto& [toml, message] : cases) EXPECT_THAT(message_of(toml), StartsWith(message));
  EXPECT_THAT(message_of("[mill]\nspeed = 0.7\nspeed = 0.8"), StartsWith("mill.toml:3: not valid TOML: "));
  EXPECT_THAT(message_of("[mill\n"), StartsWith("mill.toml:1: not valid TOML: "));
  EXPECT_THAT(message_of(std::string("[mill]\ndiameter = 1\n\0x", 22)), StartsWith("mill.toml:3: not valid TOML: "));
}

TEST(ConfigFile, RangesAreCheckedWithTheLine) {
  EXPECT_THAT(message_of("[mill]\ndiameter = -1"), StartsWith("mill.toml:2: mill.diameter: "));
  EXPECT_THAT(message_of(kMill, {"charge.filling=0.95"}), StartsWith("--set: charge.filling: "));
}

TEST(ConfigFile, LifterSizesWithoutAProfileAreNotASmoothShell) {
  std::string toml = kMill;
  const std::string profile = "profile = \"rectangle\"\n";
  toml.erase(toml.find(profile), profile.size());
  const Config partial = parse_config(toml, "mill.toml");  // enough to analyse a film
  try {
    check_complete(partial);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), StartsWith("mill.toml: mill.lifters.profile: is missing; give \"rectangle\""));
  }
  EXPECT_NO_THROW(check_complete(parse_config(toml, "mill.toml", {"mill.lifters.profile=none"})));
  EXPECT_NO_THROW(check_complete(parse_config(to_toml(parse_config(kMill, "m")), "m")));
}

TEST(ConfigFile, DensityGivesTheMassOfASphere) {
  const Config c = parse_config("[charge]\nballs = [ { radius = 0.5, density = 6 } ]", "m");
  EXPECT_DOUBLE_EQ(c.charge.balls[0].mass, 3.14159265358979323846);  // pi / 6 d^3 rho
}

TEST(ConfigFile, SetOverridesAndRemovesTheOtherWay) {
  const Config c = parse_config(
      kMill, "mill.toml",
      {"mill.speed_rpm=40", "charge.count = 148.0", "run.spin_up=auto", "mill.lifters.profile=triangle",
       "charge.balls=[{radius=0.01, mass=0.03}]", "contact.wall.friction=0.35", "contact.wall.friction=0.3"});
  EXPECT_TRUE(std::isnan(c.mill.speed));
  EXPECT_EQ(c.mill.speed_rpm, 40);
  EXPECT_TRUE(std::isnan(c.charge.filling));
  EXPECT_EQ(c.charge.count, 148);
  EXPECT_TRUE(c.run.spin_up_auto);
  EXPECT_EQ(c.mill.lifters.profile, LifterProfile::kTriangle);
  EXPECT_EQ(c.charge.balls.size(), 1u);
  EXPECT_EQ(c.contact.wall.friction, 0.3);
  EXPECT_EQ(place_of(c, "charge.count"), "--set: charge.count");
  EXPECT_EQ(place_of(c, "mill.speed"), "mill.toml: mill.speed");  // it is no longer said anywhere
  EXPECT_EQ(place_of(c, "mill.length"), "mill.toml:3: mill.length");
}

TEST(ConfigFile, SetNamesItsMistakes) {
  EXPECT_THAT(message_of(kMill, {"mill.sped=0.7"}), "--set: mill.sped: unknown key; did you mean mill.speed?");
  EXPECT_THAT(message_of(kMill, {"mill.speed"}),
              "--set: found \"mill.speed\", must be KEY=VALUE such as mill.speed=0.7");
  EXPECT_THAT(message_of(kMill, {"mill.speed="}), HasSubstr("--set: mill.speed: has no value"));
  EXPECT_THAT(message_of(kMill, {"mill.speed=[0.7"}), HasSubstr("is not valid TOML"));
  EXPECT_THAT(message_of(kMill, {"mill.speed=0.7\nx=2"}), HasSubstr("more than one value"));
  EXPECT_THAT(message_of(kMill, {"mill.speed=fast"}), HasSubstr("found the string \"fast\""));
}

TEST(ConfigFile, AcceptsWhatEditorsLeave) {
  std::string windows = "\xEF\xBB\xBF";  // byte-order mark
  for (const char c : kMill) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(to_toml(parse_config(windows, "w")), to_toml(parse_config(kMill, "u")));
  EXPECT_TRUE(std::isnan(parse_config("", "empty").mill.diameter));
}

void expect_same_bits(double a, double b) {
  EXPECT_EQ(std::bit_cast<std::uint64_t>(a), std::bit_cast<std::uint64_t>(b));
}

// Every number of a config gets random bits; the text must carry them all.
TEST(ConfigFile, WritesEveryPoint) {
  Random random(8);
  Config c = parse_config(kMill, "mill.toml");
  const auto near = [&](double x) { return x * random.uniform(0.9, 1.1); };
  c.mill.lifters.profile = LifterProfile::kPolygon;
  c.mill.lifters.height = c.mill.lifters.width = kNotGiven;
  c.mill.lifters.points = {{0, near(-0.01)}, {near(0.02), near(-0.005)}, {near(0.02), near(0.005)}, {0, near(0.01)}};
  EXPECT_EQ(parse_config(to_toml(c), "again").mill.lifters.points, c.mill.lifters.points);
}

TEST(ConfigFile, WritesEveryBit) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    Config c = parse_config(kMill, "mill.toml");
    for (const Key& key : config_keys())
      if (const auto* field = std::get_if<double& (*)(Config&)>(&key.field); field && !std::isnan((*field)(c)))
        (*field)(c) *= random.uniform(0.9, 1.1);
    c.run.seed = random.next() >> 1;
    c.run.time_step = trial % 2 ? random.uniform() * 1e-5 : kNotGiven;
    c.run.spin_up_auto = trial % 3 == 0;
    if (c.run.spin_up_auto) c.run.spin_up = RunPlan{}.spin_up;
    for (BallClass& b : c.charge.balls) b.mass = random.uniform();
    c.effects["rolling_resistance"]["coefficient"] = {random.uniform()};
    c.effects["missing_lifters"]["lifters"] = {2, 7};
    const Config back = parse_config(to_toml(c), "again");
    EXPECT_EQ(back.effects, c.effects);
    for (const Key& key : config_keys())
      if (const auto* field = std::get_if<double& (*)(Config&)>(&key.field))
        expect_same_bits((*field)(c), (*field)(const_cast<Config&>(back)));
    ASSERT_EQ(back.charge.balls.size(), c.charge.balls.size());
    for (std::size_t i = 0; i < c.charge.balls.size(); ++i)
      expect_same_bits(back.charge.balls[i].mass, c.charge.balls[i].mass);
    expect_same_bits(back.run.time_step, c.run.time_step);
    expect_same_bits(back.run.spin_up, c.run.spin_up);
    EXPECT_EQ(back.run.spin_up_auto, c.run.spin_up_auto);
    EXPECT_EQ(back.run.seed, c.run.seed);
    EXPECT_EQ(back.mill.lifters.count, c.mill.lifters.count);
    EXPECT_EQ(back.mill.lifters.profile, c.mill.lifters.profile);
    EXPECT_EQ(back.charge.count, c.charge.count);
  }
}

// A row of the table that nobody can reach, or that two rows share, would lose a value silently.
TEST(ConfigFile, EveryKeyIsReadIntoItsOwnField) {
  for (const Key& key : config_keys()) {
    if (!std::holds_alternative<double& (*)(Config&)>(key.field)) continue;
    const Config plain = parse_config("", "m");
    const std::string value = key.path.starts_with("contact.friction") || key.path.ends_with("friction") ||
                                      key.path.ends_with("restitution") || key.path.ends_with("filling") ||
                                      key.path.starts_with("measurement")
                                  ? "0.25"
                                  : "3.25";
    Config set;
    ASSERT_NO_THROW(set = parse_config("", "m", {key.path + "=" + value})) << key.path;
    std::vector<std::string> changed;
    for (const Key& other : config_keys())
      if (const auto* f = std::get_if<double& (*)(Config&)>(&other.field))
        if (std::bit_cast<std::uint64_t>((*f)(set)) != std::bit_cast<std::uint64_t>((*f)(const_cast<Config&>(plain))))
          changed.push_back(other.path);
    EXPECT_THAT(changed, testing::ElementsAre(key.path));
  }
}

class ConfigFileOnDisk : public testing::Test {
 protected:
  ConfigFileOnDisk()
      : folder_(std::filesystem::temp_directory_path() / ("config_file_test_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~ConfigFileOnDisk() override { std::filesystem::remove_all(folder_); }
  std::string message(const std::string& name) const {
    try {
      read_config(folder_ / name);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }
  std::filesystem::path folder_;
};

TEST_F(ConfigFileOnDisk, RefusesWhatIsNoConfig) {
  EXPECT_THAT(message("none.toml"), HasSubstr("none.toml: no such file"));
  EXPECT_THAT(message(""), HasSubstr("is a folder"));
  std::ofstream(folder_ / "big.toml") << std::string(2 << 20, '#');
  EXPECT_THAT(message("big.toml"), HasSubstr("is larger than 1 MiB"));
  std::ofstream(folder_ / "film.mp4") << std::string("\0\0\0 ftypisom\xff\xfe", 15);
  EXPECT_THAT(message("film.mp4"), AllOf(HasSubstr("film.mp4:1: not valid TOML"), testing::Not(HasSubstr("\n"))));
  std::ofstream(folder_ / "mill.toml") << kMill;
  EXPECT_EQ(message("mill.toml"), "no error");
}

// Rows belong together: nothing is sorted or thought double.
TEST(ConfigFile, TablesKeepTheirRows) {
  const Config c =
      parse_config("[effects.tabulated_friction]\nspeed = [0, 0.5, 1]\nfriction = [0.2, 0.1, 0.1]\n", "mill.toml");
  EXPECT_EQ(c.effects.at("tabulated_friction").at("friction"), (std::vector{0.2, 0.1, 0.1}));
  EXPECT_EQ(parse_config(to_toml(c), "again.toml").effects, c.effects);
}

}  // namespace
}  // namespace tumble::io
