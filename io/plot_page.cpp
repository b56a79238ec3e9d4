#include "io/plot_page.h"

#include <fmt/format.h>

#include "io/output.h"
#include "io/report/embedded.h"
#include "io/report/figure.h"
#include "io/report/html.h"
#include "io/report/section.h"

namespace tumble::io {
using namespace report;

void write_plot_page(const std::filesystem::path& path, const PlotPage& page) {
  std::string sections;
  Json plots = Json::array();
  for (std::size_t i = 0; i < page.sections.size(); ++i) {
    const std::string id = fmt::format("plot-{}", i);
    sections += section_html(page.sections[i], id);
    for (Json& plot : plots_json(page.sections[i].plots, id)) plots.push_back(std::move(plot));
  }
  write_text(path, filled(plots_html, {{"kind", escaped(page.kind)},
                                       {"top", std::string(top_html)},
                                       {"head", head_html(page.title)},
                                       {"title", escaped(page.title)},
                                       {"lead", escaped(page.lead)},
                                       {"caveats", caveats_html(page.caveats)},
                                       {"sections", sections},
                                       {"footer", footer_html(page.version)},
                                       {"data", script_json({{"plots", plots}})},
                                       {"uplot_js", std::string(uplot_js)},
                                       {"plots_js", std::string(plots_js)}}));
}

}  // namespace tumble::io
