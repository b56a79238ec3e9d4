#include "io/csv_file.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/error.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;
using testing::StartsWith;

std::string refusal(const std::string& text, const std::string& column = "") {
  try {
    const CsvTable table = parse_csv(text, "t.csv");
    if (!column.empty()) table.numbers(column);
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(CsvFile, ReadsColumnsByNameWhateverTheirOrderAndTheLineEnds) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text = "\xef\xbb\xbf# made by hand, \"really\n\nheight_m , size_mm,note\n0.30,3.35-4.0,\n";
    text += "  +1e-3 ,\t\"a, \"\"b\"\"\" , last";
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size())
      text.replace(at, 1, end);
    const CsvTable table = parse_csv(text, "t.csv");
    EXPECT_THAT(table.columns(), ElementsAre("height_m", "size_mm", "note"));
    EXPECT_THAT(table.numbers("height_m"), ElementsAre(0.3, 1e-3));
    EXPECT_THAT(table.texts("size_mm"), ElementsAre("3.35-4.0", "a, \"b\""));
    EXPECT_THAT(table.texts("note", true), ElementsAre("", "last"));
    EXPECT_EQ(table.place(1, "height_m"), "t.csv:5:3");
  }
}

TEST(CsvFile, WhatIsNotThereIsNoNumber) {
  const CsvTable table = parse_csv("a,b\n1,\n2,3\n", "t.csv");
  EXPECT_THAT(table.numbers("b", true), ElementsAre(IsNan(), 3));
  EXPECT_THAT(table.numbers("c", true), ElementsAre(IsNan(), IsNan()));
  EXPECT_THAT(table.texts("c", true), ElementsAre("", ""));
}

TEST(CsvFile, NamesThePlaceOfEachMistake) {
  EXPECT_THAT(refusal("# c\na,b\n1,2\n3, x1\n", "b"), StartsWith("t.csv:4:4: b is \"x1\""));
  EXPECT_THAT(refusal("a,b\n1,\n", "b"), StartsWith("t.csv:2:3: b is empty"));
  EXPECT_THAT(refusal("a\n1 2\n", "a"), StartsWith("t.csv:2:1: a is \"1 2\""));
  EXPECT_THAT(refusal("a\nnan\n", "a"), HasSubstr("give a number"));
  EXPECT_THAT(refusal("a\n1e999\n", "a"), HasSubstr("give a number"));
  EXPECT_THAT(refusal("a,b\n1,5,2\n"), AllOf(StartsWith("t.csv:2:1: 3 fields"), HasSubstr("2 columns (a, b)")));
  EXPECT_THAT(refusal("a,b\n1\n"), StartsWith("t.csv:2:1: 1 field where"));
  EXPECT_THAT(refusal("a,b\n1,2\n", "c"), AllOf(HasSubstr("no column c"), HasSubstr("a, b")));
  EXPECT_THAT(refusal("a,a\n1,2\n"), StartsWith("t.csv:1:3: a second column \"a\""));
  EXPECT_THAT(refusal("a,\n1,2\n"), StartsWith("t.csv:1:3: a column without a name"));
  EXPECT_THAT(refusal("a\n\"1\n2\n"), StartsWith("t.csv:2:1: the quote is not closed"));
  EXPECT_THAT(refusal("a\n\"1\"2\n"), StartsWith("t.csv:2:1: text after the closing quote"));
  EXPECT_THAT(refusal(std::string("a\n1\0\n", 5)), StartsWith("t.csv:2:2: is no text"));
  EXPECT_THAT(refusal("# nothing\n"), HasSubstr("is empty"));
  EXPECT_THAT(refusal("a,b\n# nothing\n"), HasSubstr("no rows"));
}

TEST(CsvFile, AMisspeltColumnIsNotPassedOver) {
  const std::vector<std::string> known{"fall_height_m", "rebound_height_m"};
  const CsvTable table = parse_csv("fall_height_m,rebound_heigth_m\n1,2\n", "t.csv");
  try {
    table.check_columns(known);
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("\"rebound_heigth_m\""), HasSubstr("did you mean rebound_height_m"),
                                HasSubstr("known: fall_height_m, rebound_height_m")));
  }
}

class CsvFileOnDisk : public InFolder {};

TEST_F(CsvFileOnDisk, IsReadWholeOrRefused) {
  write_bytes(folder_ / "t.csv", "a\n1\n");
  EXPECT_THAT(read_csv(folder_ / "t.csv").numbers("a"), ElementsAre(1));
  EXPECT_THROW(read_csv(folder_ / "missing.csv"), InputError);
  EXPECT_THROW(read_csv(folder_), InputError);
}

}  // namespace
}  // namespace tumble::io
