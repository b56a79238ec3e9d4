#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "core/random.h"
#include "render/film_look.h"

namespace tumble::render {

// A sheet to paint soft shapes on, in linear light: what stands still in a film, and decals. Premultiplied, rows from
// the top; pixel (i, j) has its centre at integer i, j.
struct Sheet {
  int width = 0, height = 0;
  std::vector<float> rgba;

  Sheet(int w, int h) : width(w), height(h), rgba(static_cast<std::size_t>(w) * h * 4) {}
  float* at(int i, int j) { return rgba.data() + 4 * (static_cast<std::size_t>(j) * width + i); }
  const float* at(int i, int j) const { return rgba.data() + 4 * (static_cast<std::size_t>(j) * width + i); }
};

using Spot = Eigen::Vector2d;  // a place on a sheet [px]

struct Paint {
  Light colour{1, 1, 1};
  double cover = 1;  // opacity
  double soft = 1;   // width of the edge [px]
};

// Any shape: `inside` is the signed distance to its edge [px], > 0 within; nothing is painted beyond the box.
void paint(Sheet& sheet, const Paint& with, const Spot& low, const Spot& high,
           const std::function<double(const Spot&)>& inside);

void paint_disc(Sheet& sheet, const Paint& with, const Spot& centre, double radius);
void paint_ring(Sheet& sheet, const Paint& with, const Spot& centre, double radius, double width);
void paint_stroke(Sheet& sheet, const Paint& with, const Spot& from, const Spot& to, double width);
void paint_line(Sheet& sheet, const Paint& with, const std::vector<Spot>& points, double width);
void paint_box(Sheet& sheet, const Paint& with, const Spot& centre, const Spot& half, double angle);
void paint_polygon(Sheet& sheet, const Paint& with, const Spot& centre, double radius, int corners, double angle);

// Signs that look like writing without being any: strokes on a grid, `count` of them in a row along `direction`.
void paint_writing(Sheet& sheet, const Paint& with, const Spot& begin, const Spot& direction, double height, int count,
                   Random& random);

// Adds light without covering.
void add_glow(Sheet& sheet, const Light& colour, const Spot& centre, const Spot& half, double angle);

// The sheet moved by so many pixels; its borders repeat.
Sheet shifted(const Sheet& sheet, const Spot& by);

// Smooth noise in [0, 1] that repeats after `period` cells.
double smooth_noise(double x, double y, int period, std::uint64_t seed);
double cloudy_noise(double x, double y, int period, int octaves, std::uint64_t seed);

// Random numbers of everyday use.
double log_uniform(Random& random, double low, double high);
bool chance(Random& random, double probability);

}  // namespace tumble::render
