#include "io/sweep_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "io/config_file.h"
#include "io/csv_file.h"
#include "io/figure_file.h"
#include "io/sweep_file.h"
#include "io/vector_page.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

bool says(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

// Two profiles at three speeds, twice each; torque of a slice is 10 + the number of the run. The last run failed.
Sweep small_sweep(const Config& mill) {
  Sweep sweep;
  sweep.mill_toml = to_toml(mill);
  sweep.varied = {{"mill.lifters.profile", {"rectangle", "triangle"}}, {"mill.speed", {"0.6", "0.7", "0.8"}}};
  sweep.repeats = 2;
  for (std::size_t i = 0; i < 12; ++i) {
    RunOutcome run;
    run.motion[motion_index("torque_N_m")] = {10.0 + static_cast<double>(i), 0.5};
    run.motion[motion_index("toe_deg")] = {230, 1};
    run.motion[motion_index("shoulder_deg")] = {358 + static_cast<double>(i % 4), 1};
    run.power = {40, 1};
    run.slices = 2;
    run.locked_balls = static_cast<double>(i);
    run.steady = i % 3 != 0;
    sweep.runs.push_back(run);
  }
  sweep.runs.back() = {};
  sweep.runs.back().error = "the charge left the mill, at 0.1 s";
  return sweep;
}

class SweepFigures : public InFolder {
 protected:
  Config mill_ = read_config(TUMBLE_SOURCE_DIR "/examples/lab_mill_55cm.toml");
  Sweep sweep_ = small_sweep(mill_);
};

TEST_F(SweepFigures, ASweepIsReadBackAsItWas) {
  write_sweep(folder_ / "s.h5", sweep_);
  write_sweep_csv(folder_ / "before.csv", sweep_);
  Sweep again = sweep_;
  again.runs = read_sweep_runs(folder_ / "s.h5", sweep_);
  write_sweep_csv(folder_ / "after.csv", again);
  EXPECT_EQ(bytes_of(folder_ / "before.csv"), bytes_of(folder_ / "after.csv"));
  EXPECT_EQ(again.runs.back().error, sweep_.runs.back().error);
  EXPECT_TRUE(again.runs[4].steady);
  EXPECT_FALSE(again.runs[3].steady);
}

TEST_F(SweepFigures, TheTableHasTheMeansOfTheMillWithTheirErrors) {
  write_sweep_figures(folder_, sweep_, mill_, {});
  const CsvTable table = read_csv(folder_ / "torque.csv");
  ASSERT_EQ(table.rows(), 6u);
  EXPECT_EQ(table.texts("series")[0], "lifters: rectangle");
  EXPECT_EQ(table.numbers("mill.speed")[1], 0.7);
  EXPECT_EQ(table.numbers("value")[1], 2 * 12.5);                  // two slices; runs 2 and 3
  EXPECT_NEAR(table.numbers("standard_error")[1], 2 * 0.5, 1e-9);  // half of what lies between two repeats
  EXPECT_EQ(table.numbers("value")[5], 2 * 20.0);                  // of its two runs one failed
}

TEST_F(SweepFigures, MorrellStandsThereOnceForLiftersThatHeDoesNotKnow) {
  write_sweep_figures(folder_, sweep_, mill_, {});
  const CsvTable table = read_csv(folder_ / "toe_shoulder.csv");
  const auto series = table.texts("series"), quantity = table.texts("quantity");
  const auto value = table.numbers("value"), speed = table.numbers("mill.speed");
  int curve = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i] != "Morrell (1996)") continue;
    ++curve;
    if (quantity[i] == "toe_deg" && speed[i] == 0.6) {
      EXPECT_NEAR(value[i], 216.5, 0.1);  // of filling 0.407
    }
  }
  EXPECT_EQ(curve, 2 * 81);
}

TEST_F(SweepFigures, AShoulderOnBothSidesOfThreeOClockIsOneLine) {
  const std::vector<Plot> plots = sweep_plots(sweep_, mill_, {});
  for (const double y : plots[3].series[0].y) EXPECT_LT(std::abs(y), 5) << "not 358";
  EXPECT_TRUE(plots[3].y_is_direction);
}

TEST_F(SweepFigures, WhatWasMeasuredTakesTheColourOfItsLine) {
  Experiments measured;
  Experiment e;
  e.sets = {{"mill.lifters.profile", "triangle"}, {"mill.speed_rpm", "40"}};
  e.torque = {90, 2};
  measured.list.push_back(e);
  const Plot torque = sweep_plots(sweep_, mill_, measured)[1];
  ASSERT_EQ(torque.series.size(), 3u);
  EXPECT_EQ(torque.series[2].label, "measured, lifters: triangle");
  EXPECT_EQ(torque.series[2].colour, torque.series[1].colour);
  EXPECT_NEAR(torque.series[2].x[0], 40 / 57.8, 1e-9);
}

TEST_F(SweepFigures, EveryKeyWithNumbersHasItsFigures) {
  sweep_.varied = {{"mill.speed", {"0.6", "0.7"}}, {"charge.filling", {"0.2", "0.3", "0.4"}}};
  EXPECT_EQ(sweep_figure_files("", sweep_).size(), 9u);  // against filling; two speeds are no curve
  sweep_.varied[0].values.push_back("0.8");
  const auto files = sweep_figure_files("", sweep_);
  EXPECT_EQ(files.front(), "power.svg");
  EXPECT_EQ(files.back(), "toe_shoulder_by_charge_filling.csv");
}

TEST_F(SweepFigures, PagesAreOfAJournalsWidthWithTheirLettersInThem) {
  write_sweep_figures(folder_, sweep_, mill_, {});
  const std::string svg = bytes_of(folder_ / "torque.svg"), pdf = bytes_of(folder_ / "toe_shoulder.pdf");
  EXPECT_TRUE(says(svg, "width=\"240.944882pt\""));  // 85 mm
  EXPECT_FALSE(says(svg, "<text"));
  EXPECT_TRUE(says(svg, "glyph"));
  EXPECT_TRUE(says(pdf, "/MediaBox [ 0 0 481.88")) << "170 mm";
  EXPECT_TRUE(says(pdf, "/FontFile2"));
}

TEST_F(SweepFigures, TheSameFigureHasTheSameBytesWhateverWasDrawnBefore) {
  write_sweep_figures(folder_, sweep_, mill_, {});
  const std::string svg = bytes_of(folder_ / "torque.svg"), pdf = bytes_of(folder_ / "torque.pdf");
  std::vector<std::filesystem::path> keep = sweep_figure_files(folder_, sweep_);
  std::erase_if(keep, [](const auto& file) { return file.stem() == "torque"; });
  write_sweep_figures(folder_, sweep_, mill_, {}, keep);
  EXPECT_EQ(svg, bytes_of(folder_ / "torque.svg"));
  EXPECT_EQ(pdf, bytes_of(folder_ / "torque.pdf"));
}

TEST_F(SweepFigures, APlotThatWouldLoseSomethingIsOurMistake) {
  EXPECT_THROW(write_figure(folder_ / "a.svg", {Plot{.y_log = true}}, 85), std::logic_error);
  EXPECT_THROW(write_figure(folder_ / "a.svg", {Plot{.level = {{1}}}}, 85), std::logic_error);
}

TEST_F(SweepFigures, MillimetresAreMillimetres) {
  VectorPage page(folder_ / "p.svg", 50, 40, "");
  page.line({{12.7, 25.4}, {38.1, 25.4}}, {});
  page.save();
  const std::string svg = bytes_of(folder_ / "p.svg");
  EXPECT_TRUE(says(svg, "M 12.7 25.4 L 38.1 25.4")) << svg;
  EXPECT_TRUE(says(svg, "matrix(2.834646,0,0,2.834646,0,0)"));
}

}  // namespace
}  // namespace tumble::io
