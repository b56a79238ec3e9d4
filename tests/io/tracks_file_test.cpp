#include "io/tracks_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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

std::string ball_problem_of(const std::string& rows) {
  try {
    parse_ball_tracks(
        "frame,time_s,id,x_m,y_m,mill_angle_deg,radius_m\n0,0.00,1,0.1,0.2,10,0.01\n0,0.00,2,0.1,0.1,10,\n" + rows,
        "tracks.csv");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(BallTracksFile, TakesWhatIsToldAndLeavesTheRestUnknown) {
  const BallTracks t = parse_ball_tracks(
      "frame,time_s,id,x_m,y_m,spin_rad_s,who\n0,0.5,3,0.1,-0.2,,a\n4,0.6,3,0.11,-0.21,7.5,b\n5,0.6,3,0.11,-0.21,7.5,"
      "b\n",
      "t.csv");
  EXPECT_EQ(t.frame, (std::vector<int>{0, 4, 5}));
  EXPECT_EQ(t.time, (std::vector<double>{0.5, 0.6, 0.6}));
  EXPECT_EQ(t.y[1], -0.21);
  EXPECT_TRUE(std::isnan(t.spin[0]));
  EXPECT_EQ(t.spin[1], 7.5);
  EXPECT_TRUE(std::isnan(t.radius[0]) && std::isnan(t.mill_angle_deg[0]));
}

TEST(BallTracksFile, ErrorsNameFileLineAndColumn) {
  using ::testing::HasSubstr;
  EXPECT_EQ(ball_problem_of("1,0.01,1,0.1,0.2,11,0.01\n"), "");
  EXPECT_THAT(ball_problem_of("1,0.01,1,nan,0.2,11,\n"), HasSubstr("tracks.csv:4:10: x_m is \"nan\""));
  EXPECT_THAT(ball_problem_of("1,0.01,1,0.1,inf,11,\n"), HasSubstr("tracks.csv:4:14: y_m is \"inf\""));
  EXPECT_THAT(ball_problem_of("1,0.01,1,0.1,0.2,11\n"), HasSubstr("tracks.csv:4:1: 6 fields where the header names 7"));
  EXPECT_THAT(ball_problem_of("1,-0.01,1,0.1,0.2,11,\n"), HasSubstr("tracks.csv:4:3: time_s is -0.01 in frame 1"));
  EXPECT_THAT(ball_problem_of("1,0.01,1,0.1,0.2,11,\n0,0.02,1,0.1,0.2,11,\n"),
              HasSubstr("tracks.csv:5:1: frame 0 comes after frame 1"));
  EXPECT_THAT(ball_problem_of("1,0.01,1,0.1,0.2,11,\n1,0.02,2,0.1,0.2,11,\n"),
              HasSubstr("tracks.csv:5:3: time_s is 0.02"));
  EXPECT_THAT(ball_problem_of("1,0.01,1,0.1,0.2,11,\n1,0.01,2,0.1,0.2,12,\n"), HasSubstr("tracks.csv:5:18"));
  EXPECT_THAT(ball_problem_of("1,0.01,7,0.1,0.2,11,\n1,0.01,7,0.1,0.1,11,\n"),
              HasSubstr("tracks.csv:5:8: ball 7 is in frame 1 twice"));
  EXPECT_THAT(ball_problem_of("1,0.01,1,0.1,0.2,11,0\n"), HasSubstr("tracks.csv:4:21: radius_m is 0"));
}

}  // namespace
}  // namespace tumble::io
