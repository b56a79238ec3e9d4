#include "io/tracks_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace tumble::io {
namespace {

std::string problem_of(const std::string& text) {
  try {
    parse_pixel_tracks(text, "tracks.csv");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(TracksFile, TakesColumnsAndRowsInAnyOrderAndLeavesOthersAlone) {
  const PixelTracks tracks = parse_pixel_tracks(
      "# a comment\nframe,track,confidence,r_px,y_px,x_px\n3,1,0.9,8.5,200,100\n# another\n2,1,0.8,8,201,99.5\n",
      "t.csv");
  ASSERT_EQ(tracks.sightings.size(), 2u);
  EXPECT_EQ(tracks.name, "t.csv");
  EXPECT_EQ(tracks.sightings[0].frame, 3);
  EXPECT_EQ(tracks.sightings[1].u, 99.5);
  EXPECT_EQ(tracks.sightings[1].v, 201);
  EXPECT_EQ(tracks.sightings[1].radius, 8);
}

TEST(TracksFile, ErrorsNameFileLineAndColumn) {
  const std::string head = "track,frame,x_px,y_px,r_px\n1,0,100,100,8\n";
  EXPECT_THAT(problem_of(head + "1,1,high,100,8\n"), ::testing::HasSubstr("tracks.csv:3:5: x_px is \"high\""));
  EXPECT_THAT(problem_of(head + "1,1.5,100,100,8\n"), ::testing::HasSubstr("tracks.csv:3:3: frame is 1.5"));
  EXPECT_THAT(problem_of(head + "1,1,100,100,0\n"), ::testing::HasSubstr("tracks.csv:3:13: r_px is 0"));
  EXPECT_THAT(problem_of(head + "2,0,50,50,8\n1,0,101,100,8\n"),
              ::testing::HasSubstr("tracks.csv:4:1: track 1 is in frame 0 twice"));
  EXPECT_THAT(problem_of("track,frame,x_px,y_px\n1,0,1,1\n"), ::testing::HasSubstr("has no column r_px"));
}

}  // namespace
}  // namespace tumble::io
