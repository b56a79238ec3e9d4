#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace tumble::render {

// A mill on a sheet: what it is, and, where there are several, what tells it from the others.
struct SheetMill {
  RunSetup setup;
  std::string label;
};

// The whole picture of a film: one mill with its panel, or up to 12 mills side by side in cells with their labels, at
// one scale in metres and one of colours, over one clock.
class Sheet {
 public:
  Sheet(const std::vector<SheetMill>& mills, const Style& style);
  ~Sheet();
  Sheet(const Sheet&) = delete;
  Sheet& operator=(const Sheet&) = delete;

  void set_scale(double low, double high);                      // as Renderer::set_scale, for all
  void set_mean(std::size_t mill, const ChargeMotion& motion);  // as Renderer::set_mean, of one
  void set_force_scale(double high);                            // as Renderer::set_force_scale, for all
  double trail_seconds() const;                                 // the longest

  // Of several mills: how a film's picture fits into a cell, and that it is shown there instead of the mill's frame
  // from now on. What is transparent shows the ground.
  FilmSquare square() const;
  void set_picture(std::size_t mill, Image picture);

  // A frame and its moment for every mill; `clock`: since the film began [s], shown where there are several mills.
  // The picture is valid until the next draw.
  const Image& draw(std::span<const Frame> frames, std::span<const Moment> moments, double clock);
  Drawing sketch(std::span<const Frame> frames, std::span<const Moment> moments, double clock);

 private:
  struct Furniture;  // all but the cells
  std::vector<std::unique_ptr<Renderer>> cells_;
  std::vector<Image> films_;              // pictures in place of frames; empty ones without
  std::unique_ptr<Furniture> furniture_;  // none for one mill
  Image picture_;
};

inline constexpr std::size_t kMostMills = 12;

}  // namespace tumble::render
