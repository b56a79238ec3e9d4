#pragma once
#include <string>
#include <vector>

#include "io/plot_page.h"
#include "io/report/html.h"

// Plots on a page: a place in its HTML, and an entry in its data that plots.js draws there (`tumblePlots.drawAll`).
namespace tumble::io::report {

// <figure>s, two in a row where the page is wide; `id` must be unique on the page: places are id-0, id-1, ...
std::string figures_of(const std::vector<Plot>& plots, const std::string& id);

// What plots.js needs to draw them: goes into the page's data as an element of "plots".
Json plots_json(const std::vector<Plot>& plots, const std::string& id);

}  // namespace tumble::io::report
