#include "io/csv_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/error.h"
#include "io/config_keys.h"
#include "io/text_file.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLargestMiB = 4096;  // tracks of a long film

bool is_end(char c) { return c == '\n' || c == '\r'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }

std::string shown(std::string_view text) {
  std::string out(text.substr(0, 60));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return '"' + out + (text.size() > 60 ? "..." : "") + '"';
}

// file:line:column of a character, counted from 1.
std::string place_in(const std::string& text, std::size_t at, const std::string& name) {
  std::size_t line = 1, begin = text.starts_with("\xef\xbb\xbf") ? 3 : 0;
  for (std::size_t i = begin; i < at; ++i) {
    if (!is_end(text[i])) continue;
    if (text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n') ++i;
    ++line;
    begin = i + 1;
  }
  return fmt::format("{}:{}:{}", name, line, at - std::min(at, begin) + 1);
}

struct Cell {
  std::string text;
  std::size_t next = 0;  // where the field's comma or line end stands, or the text ends
  const char* fault = nullptr;
};

// The field that begins at `at` (blanks before it are passed over already).
Cell cell_at(const std::string& text, std::size_t at) {
  Cell cell;
  std::size_t i = at;
  if (i < text.size() && text[i] == '"') {
    for (++i;; ++i) {
      if (i >= text.size()) return {cell.text, i, "the quote is not closed; end the field with \""};
      if (text[i] == '"' && (++i >= text.size() || text[i] != '"')) break;
      cell.text += text[i];
    }
    while (i < text.size() && is_blank(text[i])) ++i;
    if (i < text.size() && text[i] != ',' && !is_end(text[i]))
      return {cell.text, i, "text after the closing quote; write a quote inside a field as \"\""};
  } else {
    while (i < text.size() && text[i] != ',' && !is_end(text[i])) ++i;
    std::size_t end = i;
    while (end > at && is_blank(text[end - 1])) --end;
    cell.text = text.substr(at, end - at);
  }
  cell.next = i;
  return cell;
}

}  // namespace

CsvTable parse_csv(std::string text, const std::string& name) {
  CsvTable table;
  table.name_ = name;
  table.text_ = std::move(text);
  const std::string& all = table.text_;
  const auto fail = [&](std::size_t at, const std::string& problem) {
    throw InputError(place_in(all, at, name), problem);
  };
  if (const auto nul = all.find('\0'); nul != std::string::npos) fail(nul, "is no text; give comma-separated values");
  std::vector<std::size_t> row;  // beginnings of the fields of a line
  for (std::size_t at = all.starts_with("\xef\xbb\xbf") ? 3 : 0; at < all.size();) {
    const std::size_t line = at;
    const std::size_t end = std::min(all.find_first_of("\r\n", at), all.size());
    if (all[at] == '#' || std::all_of(all.begin() + static_cast<std::ptrdiff_t>(at),
                                      all.begin() + static_cast<std::ptrdiff_t>(end), is_blank)) {
      at = end + 1;
      continue;
    }
    const bool header = table.names_.empty();
    row.clear();
    for (;; ++at) {
      while (at < all.size() && is_blank(all[at])) ++at;
      row.push_back(at);
      const Cell cell = cell_at(all, at);
      if (cell.fault) fail(at, cell.fault);
      if (header) {
        if (cell.text.empty()) fail(at, "a column without a name; the first line names the columns");
        if (table.has(cell.text)) fail(at, "a second column " + shown(cell.text) + "; name each column once");
        table.names_.push_back(cell.text);
      }
      at = cell.next;
      if (at >= all.size() || all[at] != ',') break;
    }
    ++at;  // over the line's end; the second half of \r\n is an empty line
    if (header) continue;
    if (row.size() != table.names_.size())
      fail(line,
           fmt::format("{} field{} where the header names {} column{} ({})", row.size(), row.size() == 1 ? "" : "s",
                       table.names_.size(), table.names_.size() == 1 ? "" : "s", fmt::join(table.names_, ", ")));
    table.begin_.insert(table.begin_.end(), row.begin(), row.end());
  }
  if (table.names_.empty()) throw InputError(name, "is empty; the first line names the columns");
  if (table.begin_.empty()) throw InputError(name, "has no rows below its header; give at least one");
  return table;
}

CsvTable read_csv(const fs::path& path) { return parse_csv(read_text(path, "a CSV file", kLargestMiB), path.string()); }

bool CsvTable::has(const std::string& column) const {
  return std::find(names_.begin(), names_.end(), column) != names_.end();
}

void CsvTable::check_columns(std::span<const std::string> known) const {
  for (const std::string& column : names_)
    if (std::find(known.begin(), known.end(), column) == known.end())
      throw InputError(name_, fmt::format("unknown column {}; did you mean {}? known: {}", shown(column),
                                          nearest_word(column, known), fmt::join(known, ", ")));
}

std::size_t CsvTable::index(const std::string& column) const {
  const auto at = std::find(names_.begin(), names_.end(), column);
  if (at == names_.end())
    throw InputError(name_, fmt::format("has no column {}; it has {}", column, fmt::join(names_, ", ")));
  return static_cast<std::size_t>(at - names_.begin());
}

std::string CsvTable::place(std::size_t row, const std::string& column) const {
  return place_in(text_, begin_[row * names_.size() + index(column)], name_);
}

std::vector<std::string> CsvTable::texts(const std::string& column, bool may_be_empty) const {
  std::vector<std::string> out(rows());
  if (may_be_empty && !has(column)) return out;
  const std::size_t at = index(column);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = cell_at(text_, begin_[i * names_.size() + at]).text;
    if (out[i].empty() && !may_be_empty) throw InputError(place(i, column), column + " is empty; give a value");
  }
  return out;
}

std::vector<double> CsvTable::numbers(const std::string& column, bool may_be_empty) const {
  std::vector<double> out(rows(), kNotGiven);
  if (may_be_empty && !has(column)) return out;
  const std::size_t at = index(column);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::string text = cell_at(text_, begin_[i * names_.size() + at]).text;
    if (text.empty() && may_be_empty) continue;
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, out[i]);
    if (error != std::errc() || stop != end || !std::isfinite(out[i]))
      throw InputError(place(i, column), column + (text.empty() ? " is empty" : " is " + shown(text)) +
                                             "; give a number, with a point for decimals");
  }
  return out;
}

std::string csv_text(const std::string& value) {
  if (value.find_first_of(",\"\r\n") == std::string::npos) return value;
  std::string quoted = "\"";
  for (const char c : value) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace tumble::io
