#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::io {

// A table of comma-separated values (RFC 4180: fields may stand in double quotes, "" is a quote; UTF-8, any line
// ends). Lines that begin with # are comments, empty lines are nothing, and the first other line names the columns.
// Spaces round a field do not count. What is asked for and is missing or malformed throws InputError with file, line
// and column of characters: drops.csv:7:12: rebound_height_m is "high"; give a number.
class CsvTable {
 public:
  std::size_t rows() const { return names_.empty() ? 0 : begin_.size() / names_.size(); }
  const std::vector<std::string>& columns() const { return names_; }
  bool has(const std::string& column) const;

  // Throws InputError where a column is not among `known`: a misspelt optional column would go unseen otherwise.
  void check_columns(std::span<const std::string> known) const;

  // A column of finite numbers. With `may_be_empty`, empty fields are NaN, and so is all of a column that is not there.
  std::vector<double> numbers(const std::string& column, bool may_be_empty = false) const;
  // The same as text.
  std::vector<std::string> texts(const std::string& column, bool may_be_empty = false) const;

  // "drops.csv", or "drops.csv:7:12" where the row's field begins: for messages about a value that was read.
  const std::string& place() const { return name_; }
  std::string place(std::size_t row, const std::string& column) const;

 private:
  friend CsvTable parse_csv(std::string text, const std::string& name);
  std::size_t index(const std::string& column) const;  // throws InputError where it is not there

  std::string name_, text_;
  std::vector<std::string> names_;
  std::vector<std::uint32_t> begin_;  // of each field in text_, row by row: small even for long tables
};

// Throws InputError where the file cannot be read, names no columns or one twice, has no rows, or a row of another
// length.
CsvTable read_csv(const std::filesystem::path& path);
CsvTable parse_csv(std::string text, const std::string& name);  // `name` stands in messages for the file

// A text as a field to write: in quotes where it has commas, quotes or line ends.
std::string csv_text(const std::string& value);

}  // namespace tumble::io
