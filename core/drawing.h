#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

struct Rgba {  // sRGB, not premultiplied
  std::uint8_t r = 0, g = 0, b = 0, a = 255;
};

// A picture as shapes instead of pixels, for print: in the same coordinates as Image, where pixel (u, v) has its centre
// at integer u, v. Later shapes lie above earlier ones.
struct Drawing {
  using Point = Eigen::Vector2d;

  struct Polygon {
    std::vector<Point> corners;
    Rgba fill;
    bool has_neighbours = false;  // shares edges with others: drawn without a soft edge, which would show as a seam
  };
  struct Stroke {
    std::vector<Point> points;
    double width = 1;
    Rgba colour;
  };
  struct Ring {  // part of an annulus, or of a disc where `inner` is 0
    Point centre;
    double inner = 0, outer = 0, from = 0, to = 0;  // angles counter-clockwise from 3 o'clock [rad]
    Rgba fill;
  };
  struct Ball {
    Point centre;
    double radius = 0;
    Rgba colour;
    Point mark;                // unit direction of the painted mark
    double mark_strength = 0;  // 0 = no mark, 1 = full
  };
  struct Label {
    std::string text;
    Point at;         // on the baseline
    double size = 0;  // em
    bool is_bold = false;
    double anchor = 0;  // share of its width that lies to the left of `at`: 0, 0.5 or 1
    Rgba colour;
    Rgba halo{0, 0, 0, 0};  // an outline behind the letters, so that they read on anything
    double halo_width = 0;
  };
  struct Enter {  // until its Leave, shapes are moved and only show within a box (of the outer coordinates)
    Point offset{0, 0};
    double left = 0, top = 0, right = 0, bottom = 0;
  };
  struct Leave {};
  using Shape = std::variant<Polygon, Stroke, Ring, Ball, Label, Enter, Leave>;

  int width = 0, height = 0;  // [px]
  Rgba ground;
  std::vector<Shape> shapes;
};

}  // namespace tumble
