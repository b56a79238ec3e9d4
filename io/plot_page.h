#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"

// A page of plots, tables and text as one self-contained HTML file: opens from disk and by mail, needs no network.
// Every string is plain text in UTF-8 and is escaped where it is written; "\n" has no meaning but in `code`.
namespace tumble::io {

enum class PlotMark {
  kLine,
  kPoints,
  kSteps,  // y[i] holds from x[i] to x[i + 1]; x may be the bins' edges, one more than y
};

// What is NaN, or not positive on a logarithmic axis, is not drawn. x in any order, each with its own.
struct PlotSeries {
  std::string label = {};
  std::vector<double> x = {}, y = {};
  std::vector<double> se = {};              // standard error of y: bars at points, a band round a line; empty = none
  std::vector<double> low = {}, high = {};  // ends of bars or band where they are not y -+ se; empty = none
  PlotMark mark = PlotMark::kLine;
  bool dashed = false;
  // Of the palette: 0 grey (measured, truth), 1 orange (found), then others; series that share a number share the
  // colour. -1: the next one.
  int colour = -1;
};

// A straight line across the plot at a value of x (upright) or y (level).
struct PlotRule {
  double at = kNotGiven;
  std::string label = {};  // written beside the line; may be empty
  double se = kNotGiven;   // a band of one standard error to each side, where given
};

struct Plot {
  std::string title = {};
  std::string x_label = {}, y_label = {};  // with unit: "speed, share of critical", "torque, N m"
  bool x_log = false, y_log = false;
  bool y_from_zero = false;     // the axis includes 0 (linear axes only)
  bool x_is_direction = false;  // x in degrees, which may run past 360: named in [0, 360)
  bool y_is_direction = false;  // y likewise
  bool tall = false;            // takes the page's width and more height; else two share a row where there is room
  std::vector<PlotSeries> series = {};
  std::vector<PlotRule> upright = {}, level = {};
  std::string caption = {};
};

struct PageTable {
  std::string title = {};
  std::vector<std::string> header = {};
  std::vector<std::vector<std::string>> rows = {};  // as they are to be read: report::with_error() writes "8.12 ± 0.25"
  std::string note = {};                            // below the table
};

// In the order in which it is shown.
struct PageSection {
  std::string heading = {};
  std::vector<std::string> paragraphs = {};
  std::vector<Plot> plots = {};
  std::vector<PageTable> tables = {};
  std::string code = {};  // lines to copy, such as of MILL.toml
};

struct PlotPage {
  std::string kind = {};   // one or two words above the title: "Sweep"
  std::string title = {};  // what was found or done, in one line
  std::string lead = {};   // the first sentences
  std::vector<std::string> caveats = {};
  std::vector<PageSection> sections = {};
  std::string version = {};  // of the program
};

// Throws WorkError where the file cannot be written, std::logic_error where a series' lengths do not agree.
void write_plot_page(const std::filesystem::path& path, const PlotPage& page);

}  // namespace tumble::io
