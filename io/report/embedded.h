#pragma once
#include <string_view>

// Files that the build puts into the program (embed.cmake).
namespace tumble::io::report {

extern const std::string_view head_html_page, top_html, page_js;  // of all pages
extern const std::string_view run_html;                           // pages with {{places}} to fill
extern const std::string_view plots_html;
extern const std::string_view compare_html;
extern const std::string_view compare_js;
extern const std::string_view diagnosis_html;
extern const std::string_view diagnosis_js;
extern const std::string_view style_css;
extern const std::string_view plots_js;  // what all pages' plots share
extern const std::string_view maps_js;   // and what those with maps do
extern const std::string_view run_js;
extern const std::string_view uplot_js;  // third_party/uplot
extern const std::string_view uplot_css;

}  // namespace tumble::io::report
