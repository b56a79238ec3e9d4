#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/palette.h"
#include "render/recorder.h"
#include "render/shader.h"

namespace tumble::render {

using Vec2 = Eigen::Vector2d;  // a point of the picture [px]

// Coloured triangles whose edges fade over one pixel: smooth without multisampling, which costs llvmpipe 2 to 3 times
// as much. A shape's true edge is where its coverage is one half.
class Meshes {
 public:
  Meshes(int width, int height);

  // Added shapes are drawn by the next flush(), in the order of adding.
  void triangle(const Vec2& a, const Vec2& b, const Vec2& c, Rgba at_a, Rgba at_b, Rgba at_c);  // hard edges
  void rectangle(double left, double top, double right, double bottom, Rgba colour);            // hard edges
  void convex(std::span<const Vec2> corners, std::span<const Rgba> colours);                    // one colour a corner
  void convex(std::span<const Vec2> corners, Rgba colour);
  void line(const Vec2& a, const Vec2& b, double width, Rgba at_a, Rgba at_b);
  void line(const Vec2& a, const Vec2& b, double width, Rgba colour) { line(a, b, width, colour, colour); }
  void polyline(std::span<const Vec2> points, double width, Rgba colour);
  // Part of an annulus; `colour(angle)` with the angle in the picture, counter-clockwise from 3 o'clock [rad].
  void ring(const Vec2& centre, double inner, double outer, double from, double to,
            const std::function<Rgba(double)>& colour_inner, const std::function<Rgba(double)>& colour_outer);
  void ring(const Vec2& centre, double inner, double outer, double from, double to, Rgba colour);

  void flush();
  void record_into(Drawing* drawing) { recorder_.record_into(drawing); }  // instead of drawing

 private:
  struct Vertex {
    float x, y;
    Rgba colour;  // premultiplied
  };
  void vertex(const Vec2& p, Rgba colour);
  void record_polygon(std::span<const Vec2> corners, std::span<const Rgba> colours, bool has_neighbours);
  void quad(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d, Rgba at_a, Rgba at_b, Rgba at_c, Rgba at_d);

  Pipeline pipeline_;
  Recorder recorder_;
  std::vector<Vertex> vertices_;
};

}  // namespace tumble::render
