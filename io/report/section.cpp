#include "io/report/section.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "io/report/figure.h"
#include "io/report/html.h"

namespace tumble::io::report {
namespace {

// Does a cell begin as numbers do? A minus sign and the dash for "nothing" count.
bool is_number(const std::string& cell) {
  for (const char* sign : {"\u2212", "\u2013", "-", "+"})
    if (cell.starts_with(sign)) return true;
  return cell.empty() || std::isdigit(static_cast<unsigned char>(cell[0]));
}

}  // namespace

std::string table_html(const PageTable& table) {
  // Columns of words stand to the left, numbers to the right.
  std::vector<bool> words(table.header.size());
  for (const auto& row : table.rows)
    for (std::size_t i = 0; i < std::min(row.size(), words.size()); ++i)
      if (i == 0 || !is_number(row[i])) words[i] = true;
  const auto cell = [&](std::size_t i, const std::string& text, bool head) {
    const char* of = i < words.size() && words[i] ? " class=\"words\"" : "";
    return head     ? fmt::format("<th scope=\"col\"{}>{}</th>", of, escaped(text))
           : i == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", of, escaped(text))
                    : fmt::format("<td{}>{}</td>", of, escaped(text));
  };
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table\"><table class=\"numbers plain\">\n";
  if (!table.title.empty()) out += "<caption>" + escaped(table.title) + "</caption>\n";
  out += "<thead><tr>";
  for (std::size_t i = 0; i < table.header.size(); ++i) out += cell(i, table.header[i], true);
  out += "</tr></thead>\n<tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) out += cell(i, row[i], false);
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
  if (!table.note.empty()) out += "<p class=\"note\">" + escaped(table.note) + "</p>\n";
  return out;
}

std::string section_html(const PageSection& section, const std::string& id) {
  std::string out = "<section>\n";
  if (!section.heading.empty()) out += "<h2>" + escaped(section.heading) + "</h2>\n";
  for (const std::string& text : section.paragraphs) out += "<p>" + escaped(text) + "</p>\n";
  out += figures_of(section.plots, id);
  for (const PageTable& table : section.tables) out += table_html(table);
  if (!section.code.empty()) out += "<pre>" + escaped(section.code) + "</pre>\n";
  return out + "</section>\n";
}

}  // namespace tumble::io::report
