#pragma once
#include <string>

#include "io/plot_page.h"

namespace tumble::io::report {

// A part of a page with its heading, paragraphs, figures, tables and code. `id` as for figures_of, whose plots_json is
// still to go into the page's data.
std::string section_html(const PageSection& section, const std::string& id);

std::string table_html(const PageTable& table);  // with title and note; columns of numbers are set as such

}  // namespace tumble::io::report
