#include "io/drawing_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using testing::HasSubstr;

Drawing one_of_each() {
  Drawing d{200, 100, {10, 20, 30}, {}};
  d.shapes.emplace_back(Drawing::Ring{{50, 50}, 30, 40, 0, 2 * kPi, {200, 0, 0}});
  d.shapes.emplace_back(Drawing::Ring{{50, 50}, 30, 40, 0, kPi / 2, {200, 0, 0}});
  d.shapes.emplace_back(Drawing::Ball{{60, 40}, 12, {0, 120, 0}, {1, 0}, 1});
  d.shapes.emplace_back(Drawing::Enter{{5, 7}, 0, 0, 80, 80});
  d.shapes.emplace_back(Drawing::Polygon{{{0, 0}, {9, 0}, {0, 9}}, {1, 2, 3, 128}, true});
  d.shapes.emplace_back(Drawing::Leave{});
  d.shapes.emplace_back(Drawing::Stroke{{{1, 1}, {2.125, 3}}, 1.5, {255, 255, 255}});
  d.shapes.emplace_back(Drawing::Label{"⌀ 545 mm & <more>", {20, 90}, 13, true, 0.5, {255, 255, 255}});
  return d;
}

class DrawingFile : public InFolder {};

TEST_F(DrawingFile, SvgKeepsShapesAndText) {
  write_svg(folder_ / "a.svg", one_of_each());
  const std::string svg = bytes_of(folder_ / "a.svg");
  EXPECT_THAT(svg, HasSubstr(R"(<circle cx="50" cy="50" r="35" fill="none" stroke="#c80000" stroke-width="10"/>)"));
  // A quarter, counter-clockwise from 3 o'clock to 12: y is down in the file.
  EXPECT_THAT(svg, HasSubstr(R"(d="M85 50A35 35 0 0 0 50 15")"));
  EXPECT_THAT(svg, HasSubstr(R"(<circle cx="60" cy="40" r="11.49" fill="#007800")"));
  EXPECT_THAT(svg, HasSubstr(R"(fill-opacity="0.5" shape-rendering="crispEdges")"));
  EXPECT_THAT(svg, HasSubstr(R"(translate(5 7))"));
  EXPECT_THAT(svg, HasSubstr(R"(text-anchor="middle" fill="#ffffff">⌀ 545 mm &amp; &lt;more&gt;</text>)"));
}

TEST_F(DrawingFile, SameDrawingSameBytes) {
  for (const char* name : {"a.svg", "b.svg"}) write_svg(folder_ / name, one_of_each());
  for (const char* name : {"a.pdf", "b.pdf"}) write_pdf(folder_ / name, one_of_each());
  EXPECT_EQ(bytes_of(folder_ / "a.svg"), bytes_of(folder_ / "b.svg"));
  EXPECT_EQ(bytes_of(folder_ / "a.pdf"), bytes_of(folder_ / "b.pdf"));
  EXPECT_EQ(bytes_of(folder_ / "a.pdf").substr(0, 5), "%PDF-");
  EXPECT_THAT(bytes_of(folder_ / "a.pdf"), HasSubstr("DejaVuSans-Bold"));  // text stays text
}

TEST_F(DrawingFile, WhatCannotBeWrittenLeavesNothing) {
  EXPECT_THROW(write_svg(folder_ / "missing" / "a.svg", one_of_each()), WorkError);
  EXPECT_THROW(write_pdf(folder_ / "missing" / "a.pdf", one_of_each()), WorkError);
  EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

}  // namespace
}  // namespace tumble::io
