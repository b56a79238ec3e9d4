#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/image.h"
#include "render/renderer.h"

// Third front door of render: a run beside or over the pictures of a film of such a mill.
namespace tumble::render {

enum class BesideView { kSide, kOverlay, kWipe, kDifference };

struct BesideStyle {
  int width = 1280, height = 720;  // [px], even
  BesideView view = BesideView::kSide;
  Colour colour = Colour::kSteel;  // of the run's balls, side and wipe
  bool mirror = false;             // the film's mill turns clockwise: so does the run
  double slow = 1;                 // how many times slower than true time
  double opacity = 0.12;           // of the balls' discs in the overlay, [0, 1]
  std::size_t mean_over = 1;       // pictures: the difference is a running mean over them
};

// What is written beside the pictures.
struct BesideSource {
  std::string role, name, detail;  // "Film", the file, a line about it
};
struct BesideRow {  // of the table
  std::string name, film, run, difference;
};
struct BesideWords {
  BesideSource film, run;
  std::vector<BesideRow> table;
  std::vector<std::string> notes;
};

// How the film's own camera sees the mill, in pixels of the square: of places (as reported, `behind` the glass) and of
// balls that touch the glass. Lengths in metres. For the overlay; the other views show the film straightened.
struct FilmProjection {
  std::function<Eigen::Vector2d(double x, double y, double behind)> place;
  std::function<std::vector<Eigen::Vector2d>(double x, double y, double radius)> ball;
};

struct ChargeEdge {
  double toe_deg = kNotGiven, shoulder_deg = kNotGiven;  // NaN: no mark
};

struct FilmedBall {
  double x = 0, y = 0, radius = 0;  // [m]
};

struct BesideMoment {
  const Image* film = nullptr;  // the square's picture, transparent where it shows nothing
  const Frame* run = nullptr;
  double clock = kNotGiven;  // since the first picture [s]; NaN: a still
  ChargeEdge film_edge, run_edge;
  double wipe = 0.5;  // share of the square that shows the film
};

class BesideRenderer {
 public:
  // `radius`: of the film's mill [m]: what is one scale.
  BesideRenderer(const RunSetup& setup, const BesideStyle& style, const BesideWords& words, double radius);
  ~BesideRenderer();
  BesideRenderer(const BesideRenderer&) = delete;
  BesideRenderer& operator=(const BesideRenderer&) = delete;

  FilmSquare square() const;
  void set_projection(FilmProjection projection);  // before the first draw
  void set_scale(double low, double high);         // as Renderer's
  // The run's mean free surface [m], drawn over the balls; none where empty.
  void set_surface(std::vector<Eigen::Vector2d> run);

  // For the difference: what was found in a picture of the film, and the run at that moment.
  void compare(const std::vector<FilmedBall>& film, const Frame& run);

  // The picture; valid until the next draw.
  const Image& draw(const BesideMoment& moment);

  // Of the running mean: shares of the area that either covers.
  double only_film() const;
  double only_run() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::render
