#include "io/plot_page.h"

#include <gtest/gtest.h>

#include <regex>
#include <stdexcept>

#include "core/error.h"
#include "io/report/figure.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using report::Json;

bool says(const std::string& page, const std::string& text) { return page.find(text) != std::string::npos; }

class PlotPageFile : public InFolder {
 protected:
  std::string text_of(const PlotPage& page) const {
    write_plot_page(folder_ / "page.html", page);
    return bytes_of(folder_ / "page.html");
  }
  static Json plots_in(const std::string& page) {
    const std::string open = "<script type=\"application/json\" id=\"data\">";
    const auto begin = page.find(open) + open.size();
    return Json::parse(page.substr(begin, page.find("</script>", begin) - begin))["plots"];
  }
};

TEST_F(PlotPageFile, NoStringIsMarkup) {
  const std::string attack = "</script></pre><img src=x onerror=alert(1)>\"'{{lead}}";
  PlotPage page{attack, attack, attack, {attack}, {}, attack};
  PlotSeries series{.label = attack, .x = {1}, .y = {2}};
  Plot plot{.title = attack, .x_label = attack, .y_label = attack, .series = {series}, .caption = attack};
  plot.upright = plot.level = {{1, attack}};
  page.sections = {{attack, {attack}, {plot}, {{attack, {attack}, {{attack}}, attack}}, attack}};
  const std::string text = text_of(page);
  EXPECT_FALSE(says(text, "<img"));
  EXPECT_FALSE(says(text, "</pre><"));
  EXPECT_EQ(plots_in(text)[0]["series"][0]["label"], attack);
  EXPECT_EQ(plots_in(text)[0]["upright"][0]["label"], attack);
}

TEST_F(PlotPageFile, NeedsNothingElseAndHasAPlaceForEachPlot) {
  PlotPage page{.title = "t"};
  page.sections.resize(2);
  for (PageSection& section : page.sections) section.plots.resize(2);
  const std::string text = text_of(page);
  EXPECT_FALSE(std::regex_search(text, std::regex("(src|href)=\"?(https?:)?//")));
  EXPECT_TRUE(says(text, "default-src 'none'"));
  const Json plots = plots_in(text);
  ASSERT_EQ(plots.size(), 4u);
  for (const Json& plot : plots) EXPECT_TRUE(says(text, "id=" + plot["id"].dump())) << plot["id"];
  EXPECT_NE(plots[0]["id"], plots[2]["id"]);
}

TEST_F(PlotPageFile, WordsStandToTheLeftAndNumbersToTheRight) {
  PlotPage page{.title = "t"};
  page.sections = {
      {.tables = {{"", {"law", "k", "unit"}, {{"linear", "\u22121.5 ± 0.2", "N/m"}, {"2", "–", ""}}, ""}}}};
  const std::string text = text_of(page);
  EXPECT_TRUE(says(text, "<th scope=\"row\" class=\"words\">2</th><td>–</td><td class=\"words\"></td>"));
}

TEST(PlotFigure, SeriesAreSortedWithTheirErrorsAndRepeatsStay) {
  PlotSeries s{.label = "s", .x = {2, 1, 2, kNotGiven}, .y = {20, 10, 21, 5}, .se = {2, kNotGiven, 1, 1}};
  const Json json = report::plots_json({Plot{.series = {s}}}, "p")[0]["series"][0];
  EXPECT_EQ(json["x"], Json({1, 2, 2}));
  EXPECT_EQ(json["y"], Json({10, 20, 21}));
  EXPECT_EQ(json["low"], Json({nullptr, 18, 20}));
  EXPECT_EQ(json["high"], Json({nullptr, 22, 22}));
  EXPECT_EQ(json["mark"], "line");
}

TEST(PlotFigure, ALogarithmicAxisHasNoPlaceForZero) {
  PlotSeries s{.label = "s", .x = {0, 1, 2}, .y = {1, 0, 4}, .se = {1, 1, 5}};
  const Json json = report::plots_json({Plot{.x_log = true, .y_log = true, .series = {s}}}, "p")[0]["series"][0];
  EXPECT_EQ(json["x"], Json({1, 2}));
  EXPECT_EQ(json["y"], Json({nullptr, 4}));
  EXPECT_EQ(json["low"], Json({nullptr, 0.004}));  // the bar reaches below zero: down to where it cannot be overlooked
}

TEST(PlotFigure, StepsEndAtTheirLastEdge) {
  PlotSeries s{.label = "s", .x = {1, 2, 4}, .y = {5, 7}, .mark = PlotMark::kSteps};
  const Json json = report::plots_json({Plot{.series = {s}}}, "p")[0]["series"][0];
  EXPECT_EQ(json["x"], Json({1, 2, 4}));
  EXPECT_EQ(json["y"], Json({5, 7, 7}));
}

TEST(PlotFigure, ColumnsOfDifferentLengthsAreOurMistake) {
  EXPECT_THROW(report::plots_json({Plot{.series = {{.x = {1, 2}, .y = {1}}}}}, "p"), std::logic_error);
  EXPECT_THROW(report::plots_json({Plot{.series = {{.x = {1}, .y = {1}, .se = {1, 2}}}}}, "p"), std::logic_error);
  EXPECT_THROW(report::plots_json({Plot{.series = {{.x = {1}, .y = {1}, .low = {0}}}}}, "p"), std::logic_error);
}

}  // namespace
}  // namespace tumble::io
