#pragma once
#include <string>

#include "io/plot_page.h"

namespace tumble::io::report {

// A part of a page with its heading, paragraphs, figures, tables and code. `id` as for figures_of, whose plots_json is
// still to go into the page's data.
std::string section_html(const PageSection& section, const std::string& id);

}  // namespace tumble::io::report
