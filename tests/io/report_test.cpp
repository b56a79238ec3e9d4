#include <gmock/gmock.h>

#include <cmath>
#include <regex>

#include "core/error.h"
#include "core/mill_shape.h"
#include "io/config_file.h"
#include "io/report/html.h"
#include "io/report/mill_picture.h"
#include "io/report_file.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using namespace report;
using testing::HasSubstr;
using testing::Not;

TEST(Html, EscapesWhatMarksUp) {
  EXPECT_EQ(escaped("<a href=\"x\">'&amp;"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;amp;");
  EXPECT_EQ(escaped("caf\xc3\xa9 \xff"), "caf\xc3\xa9 \xef\xbf\xbd");  // what is no UTF-8 is replaced
}

TEST(Html, JsonInAScriptCannotEndIt) {
  const Json json = {{"name", "</script><!--\xe2\x80\xa8"}};
  const std::string text = script_json(json);
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_EQ(Json::parse(text), json);
}

TEST(Html, Base64AsInRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64(std::string("\xff\xfe\x00", 3)), "//4A");
}

TEST(Html, FillsEachPlaceOnceAndTellsOfMistakes) {
  EXPECT_EQ(filled("a {{x}} b {{y}}", {{"x", "{{y}}"}, {"y", "2"}}), "a {{y}} b 2");
  EXPECT_THROW(filled("{{x}}", {}), std::logic_error);
  EXPECT_THROW(filled("", {{"x", "1"}}), std::logic_error);
}

TEST(Html, NumbersHaveTheDigitsTheirErrorAllows) {
  EXPECT_EQ(with_error({231.4159, 0.312}), "231.42\u00a0±\u00a00.31");
  EXPECT_EQ(with_error({-0.10142, 0.0036}), "\u22120.1014\u00a0±\u00a00.0036");
  EXPECT_EQ(with_error({1234.5, 56.0}), "1234\u00a0±\u00a056");
  EXPECT_EQ(with_error({0.406913, 0}), "0.4069");
  EXPECT_EQ(with_error({0.406913, kNotGiven}), "0.4069");
  EXPECT_EQ(with_error({-0.001, 0.5}), "0.00\u00a0±\u00a00.50");
  EXPECT_EQ(with_error({}), "–");
}

// A run and its film, with numbers to look for.
struct Story {
  RunSetup setup;
  RunResult result;
  RunSummary summary;
  ChargeMotion truth, film;
  Deviation deviation;
  RunReport report;

  Story() {
    setup.config = parse_config(
        "[mill]\ndiameter = 0.5\nspeed = 0.75\n[mill.lifters]\ncount = 12\nprofile = \"triangle\"\nheight = 0.02\n"
        "width = 0.03\n[charge]\ncount = 30\nballs = [ { radius = 0.02, mass = 0.26 } ]\n",
        "mill.toml");
    setup.balls = {std::vector<double>(30, 0.02), std::vector<double>(30, 0.26)};
    setup.time_step = 1e-5;
    setup.mill_speed = 4.7;
    result.spin_up_revolutions = 2;
    setup.dissipation_causes = {"ball_ball_normal", "ball_ball_sliding", "ball_wall_normal", "ball_wall_sliding"};
    auto& s = result.spectrum;
    s.edges_J = {1e-6, 1e-5, 1e-4, 1e-3};
    s.ball_ball = {0, 7.5, 0};
    s.ball_ball_normal = {2, 5.5, 0};
    s.ball_ball_tangential = {7.5, 0, 0};
    s.ball_wall = s.ball_wall_normal = {0, 0, 2.5};
    s.ball_wall_tangential = {2.5, 0, 0};
    result.falls = {{0, 0.25, 0.5}, {4, 0.5}};
    result.places.angle_edges_deg = {0, 90, 180, 270, 360};
    for (auto* faces : {&result.places.frequency, &result.places.power})
      for (auto& face : *faces) face.assign(4, 0);
    result.places.frequency[1] = {0, 0, 2, 0.5};
    result.places.power[1] = {0, 0, 0.375, 0.125};
    result.places.frequency[0] = {1, 0, 0, 0};
    result.places.power[0] = {1.5, 0, 0, 0};
    result.places.lifter_frequency.assign(12, 0.25);
    result.places.lifter_power.assign(12, 0.0625);
    summary.torque = {8.125, 0.25};
    summary.torque_closure = {8.25, 0.25};
    summary.torque_external = {0, 0};
    summary.power = {40, 1};
    summary.slices = 3;
    summary.mill_torque = {24.375, 0.75};
    summary.mill_power = {120, 3};
    summary.dissipation = {{10, 0.5}, {12, 0.5}, {8, 0.5}, {9, 0.5}};
    summary.stored_power = 1;
    summary.time = {0, 1.0 / 60};
    summary.locked = summary.external = {0, 0};
    for (auto* m : {&truth, &film}) {
      m->frames = 2;
      m->frames_per_second = 60;
      m->toe_deg = {231.25, 0.5};
      m->shoulder_deg = {359.5, 0.5};
      for (std::size_t i = 0; i < 360; ++i) m->ring_occupancy[i] = i > 230 ? 0.75 : 0.125;
      m->profile = {{0, 0.0, 0.0, 231.0, 359.0, 0.1}, {1, 1.0 / 60, 1.0, 231.5, 0.5, 0.1}};
      m->field = {0.1, 2, {0.5, 0.5, kNotGiven, 0.25}, {}, {1, 1, 1, 1}, {0, 0, 0, 0}, {}, {}, {}};
    }
    film.toe_deg.value = 233.75;
    film.ring_occupancy[3] = kNotGiven;
    truth.torque = {8.125, 0.25};
    truth.torque_closure = {8.25, 0.25};
    truth.torque_series = {{0, 8, 37}, {1.0 / 60, 8.25, 38}};
    deviation.differences = {{"toe_deg", "deg", truth.toe_deg, film.toe_deg, 2.5, 0.7, 3.6},
                             {"shoulder_deg", "deg", truth.shoulder_deg, film.shoulder_deg, 0, 0.7, 0},
                             {"torque_N_m", "N m", truth.torque, {}, kNotGiven, kNotGiven, kNotGiven}};
    report.setup = &setup;
    report.result = &result;
    report.summary = &summary;
    report.truth = &truth;
    report.film = &film;
    report.deviation = &deviation;
    report.config_text = to_toml(setup.config);
    report.version = "1.2.3";
  }
};

// Not gmock's HasSubstr, which would print half a megabyte where it fails.
bool says(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

class Report : public InFolder {
 protected:
  std::string page_of(const Story& story) const {
    write_run_report(folder_ / "report.html", story.report);
    return bytes_of(folder_ / "report.html");
  }
  static Json data_in(const std::string& page) {
    const std::string open = "<script type=\"application/json\" id=\"data\">";
    const auto begin = page.find(open) + open.size();
    return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  }
};

TEST_F(Report, SaysFirstWhatWasRunAndFound) {
  const std::string page = page_of({});
  EXPECT_TRUE(says(page,
                   "<p class=\"lead\">30 balls were tumbled for 6 revolutions, after 2 of spin-up, at 0.75 of "
                   "critical speed"));
  EXPECT_TRUE(says(page, "with 12 triangular lifters"));
  EXPECT_TRUE(says(page,
                   "the toe was found at 233.75\u00a0±\u00a00.50° and the shoulder at 359.50\u00a0±\u00a00.50°, "
                   "2.5° and 0.0° from where the simulation has them."));
  EXPECT_TRUE(says(page, "8.12\u00a0±\u00a00.25 N\u00a0m"));
  EXPECT_TRUE(says(page, "tumble 1.2.3"));
}

TEST_F(Report, MarksWhatIsNoAccidentAndLeavesOutWhatAFilmCannotHave) {
  const std::string page = page_of({});
  EXPECT_TRUE(std::regex_search(page, std::regex("<tr class=\"far\"><th scope=\"row\">Toe</th>")));
  EXPECT_TRUE(std::regex_search(page, std::regex("<tr><th scope=\"row\">Shoulder</th>")));
  EXPECT_FALSE(says(page, "<th scope=\"row\">Torque"));
}

TEST_F(Report, DrawsWhatIsInTheFiles) {
  const Json data = data_in(page_of({}));
  EXPECT_EQ(data["occupancy"]["truth"].size(), 360u);
  EXPECT_EQ(data["occupancy"]["truth"][240], 0.75);
  EXPECT_TRUE(data["occupancy"]["film"][3].is_null());
  EXPECT_EQ(data["occupancy"]["start"], 120);                  // opposite the charge's middle, 295 degrees
  EXPECT_EQ(data["truth"]["shoulder"], Json({359.0, 360.5}));  // no jump at 3 o'clock
  EXPECT_EQ(data["torque"]["torque"], Json({8.0, 8.25}));
  EXPECT_NEAR(data["film_seconds"].get<double>(), 2.0 / 60, 1e-6);
}

// The plot whose page gives it this title.
Json plot_titled(const std::string& page, const Json& data, const std::string& title) {
  const auto at = page.find("<h3>" + title + "</h3>");
  if (at == std::string::npos) return nullptr;
  const auto id = page.find("id=\"", at) + 3;
  const std::string quoted = page.substr(id, page.find('"', id + 1) + 1 - id);
  for (const Json& plot : data["plots"])
    if (plot["id"].dump() == quoted) return plot;
  return nullptr;
}

TEST_F(Report, DrawsImpactsAsNumbersAndAsPower) {
  const std::string page = page_of({});
  const Json data = data_in(page);
  const Json impacts = plot_titled(page, data, "Impacts by energy, ball on ball");
  const Json power = plot_titled(page, data, "Power by energy of impact, ball on ball");
  ASSERT_FALSE(impacts.is_null() || power.is_null());
  EXPECT_EQ(impacts["series"][0]["x"], Json({1e-5, 1e-4, 1e-3}));  // the bins with impacts, of any kind
  EXPECT_EQ(impacts["series"][0]["y"], Json({7.5, nullptr, nullptr}));
  EXPECT_EQ(impacts["series"][1]["y"], Json({5.5, nullptr, nullptr}));
  const double middle = 7.5 * std::sqrt(1e-5 * 1e-4);
  EXPECT_NEAR(power["series"][0]["y"][0].get<double>(), middle, 1e-9);
  EXPECT_NEAR(power["upright"][0]["at"].get<double>(), std::sqrt(1e-5 * 1e-4), 1e-9);  // half of the one bin
  EXPECT_TRUE(says(page, "goes in impacts of more than 0.00032 J")) << "ball on wall: half of its one bin";

  const Json falls = plot_titled(page, data, "Fall heights");
  ASSERT_FALSE(falls.is_null());
  EXPECT_EQ(falls["series"][0]["x"], Json({0, 0.25, 0.5}));
  EXPECT_EQ(falls["series"][0]["y"], Json({4, 0.5, 0.5}));
}

// Cut open opposite the charge, at 120 degrees: the bins from 180 on come first, the others a turn later.
TEST_F(Report, LaysImpactsRoundTheShell) {
  const std::string page = page_of({});
  const Json where = plot_titled(page, data_in(page), "Where on the shell");
  ASSERT_FALSE(where.is_null());
  ASSERT_EQ(where["series"].size(), 2u) << "faces without an impact are left out";
  const Json& leading = where["series"][1];
  EXPECT_EQ(leading["label"], "leading faces");
  EXPECT_EQ(leading["x"], Json({180, 270, 360, 450, 540}));
  EXPECT_EQ(leading["y"], Json({0.375, 0.125, 0, 0, 0}));
  EXPECT_TRUE(says(page, "<th scope=\"row\" class=\"words\">leading faces</th><td>2.5</td><td>0.5</td><td>25.0</td>"));
}

TEST_F(Report, SaysWhereThePowerGoesAndWhatTheMillTakes) {
  const std::string page = page_of({});
  EXPECT_TRUE(says(page, "Ball on ball, sliding</th><td>12.00\u00a0±\u00a00.50</td><td>30.0</td>"));
  EXPECT_TRUE(says(page, "The file gives no length (mill.length), so the slice stands for the mill."));
  EXPECT_TRUE(says(page, "<td>8.12\u00a0±\u00a00.25</td><td>24.38\u00a0±\u00a00.75</td>"));
  EXPECT_TRUE(says(page, "The mill was steady while the averages were taken"));
  EXPECT_FALSE(says(page, "Effects that are on"));
  EXPECT_FALSE(says(page, "Torque of fluid and pool"));
}

TEST_F(Report, ShowsEffectsFluidAndLockedBallsWhereThereAreAny) {
  Story story;
  story.setup.config.effects["fluid_drag"]["viscosity"] = {0.088};
  story.setup.config.effects["cohesion"]["force"] = {0};  // as good as absent
  story.summary.external = {-0.5, -0.25};
  story.summary.torque_external = {-0.375, 0.125};
  story.summary.locked = {0, 3};
  story.summary.locked_balls = 3;
  const std::string page = page_of(story);
  EXPECT_TRUE(says(page, "<td class=\"words\">viscosity</td>"));
  EXPECT_TRUE(says(page, "<td>0.088</td>"));
  EXPECT_FALSE(says(page, "cohesion:"));
  EXPECT_TRUE(says(page, "On average \u22120.38\u00a0±\u00a00.12 N\u00a0m about the axis."));
  EXPECT_TRUE(says(page, "At the end 3 of 30 balls had turned with the shell"));
}

TEST_F(Report, CarriesTheFilmAndNeedsNothingElse) {
  Story story;
  write_bytes(folder_ / "film.mp4", "foob");
  story.report.film_file = folder_ / "film.mp4";
  const std::string page = page_of(story);
  EXPECT_TRUE(says(page, "src=\"data:video/mp4;base64,Zm9vYg==\""));
  EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)=\"?(https?:)?//")));
  EXPECT_FALSE(std::regex_search(page, std::regex("@import|fetch\\(|XMLHttpRequest|url\\(")));
  EXPECT_TRUE(says(page, "default-src 'none'"));
}

TEST_F(Report, AFilmThatIsGoneLeavesNoReport) {
  Story story;
  story.report.film_file = folder_ / "film.mp4";
  EXPECT_THROW(page_of(story), WorkError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(Report, StringsFromFilesAreNeverMarkup) {
  Story story;
  const std::string attack = "</script></pre><script>alert(1)</script>\"'{{lead}}";
  story.result.caveat = attack + "1";
  story.truth.caveats = {attack + "2"};
  story.film.caveats = {attack + "3"};
  story.film.origin = attack;
  story.report.config_text = "# " + attack;
  story.report.version = attack;
  story.deviation.differences[0].name = attack;
  story.deviation.differences[0].unit = attack;
  const std::string page = page_of(story);
  EXPECT_FALSE(says(page, "<script>alert"));
  EXPECT_FALSE(says(page, "</pre><script"));
  EXPECT_TRUE(says(page, "&lt;/script&gt;&lt;/pre&gt;"));
  EXPECT_NO_THROW(data_in(page));
}

TEST_F(Report, CaveatsStandBeforeTheNumbers) {
  Story story;
  EXPECT_FALSE(says(page_of(story), "Before you believe"));
  story.result.steady = false;
  EXPECT_TRUE(says(page_of(story), "The averages still drifted"));
  story.film.caveats = {"the rim is hidden"};
  const std::string page = page_of(story);
  EXPECT_LT(page.find("Film: the rim is hidden"), page.find("class=\"keys\""));
}

TEST_F(Report, SaysWhenTheFilmGaveNothing) {
  Story story;
  story.film = {};
  story.film.ring_occupancy.fill(kNotGiven);
  story.deviation.differences.clear();
  const std::string page = page_of(story);
  EXPECT_TRUE(says(page, "The film alone did not give both toe and shoulder."));
  EXPECT_TRUE(says(page, "<dt>Toe in the film</dt><dd>not found<small>"));
}

// Toe at 270 degrees is straight down: in the picture's coordinates (y down) at positive y.
TEST(MillPicture, PutsAnglesWhereTheyAre) {
  ChargeMotion m;
  m.toe_deg.value = 270;
  m.field.n = 0;
  Mill mill;
  mill.diameter = 1;
  const std::string svg = mill_picture(make_mill_shape(mill), m, nullptr, "a \"mill\"");
  EXPECT_THAT(svg, HasSubstr("aria-label=\"a &quot;mill&quot;\""));
  EXPECT_TRUE(std::regex_search(svg, std::regex("<path class=\"mark\" d=\"M-0.00 -80.00L-0.00 -108.00\"/>")));
  EXPECT_THAT(svg, HasSubstr("<text y=\"112.0\" text-anchor=\"middle\"><tspan x=\"-0.0\">toe</tspan>"));
  EXPECT_THAT(svg, Not(HasSubstr("shoulder")));
}

}  // namespace
}  // namespace tumble::io
