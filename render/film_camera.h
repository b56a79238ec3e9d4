#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "core/image.h"
#include "core/mill_shape.h"
#include "render/film_look.h"

// Second front door of render: a mill as a camera in a laboratory films it, with the truth about what is seen.
// Mill frame: x right, y up, z along the axis towards the camera; z = 0 is the inside of the front glass.
namespace tumble::render {

struct FilmScene {
  MillShape shape;
  double length = 0;            // inside, glass to back plate [m]
  bool clockwise = false;       // filmed from the other end: x -> -x for all that follows
  std::vector<double> radius;   // of each ball [m]
  std::vector<int> ball_class;  // of each ball
};

struct BallState {
  double x = 0, y = 0, z = 0;  // [m]; z in [-length + r, -r]
  double vx = 0, vy = 0;       // [m/s]
  double angle = 0, spin = 0;  // of the ball's mark [rad], [rad/s]
};

// What happens round the middle of a picture's exposure; states as simulated (counter-clockwise).
struct FilmMoment {
  double time = 0;                        // of the middle of the exposure of the picture's middle row [s]
  double mill_angle = 0, mill_speed = 0;  // [rad], [rad/s]
  Eigen::Vector2d shake{0, 0};            // of a camera that does not stand still: all of the picture moves by it [px]
  std::function<BallState(std::size_t ball, double later)> ball;  // `later`: seconds after `time`, may be negative
};

struct SeenBall {  // at the middle of the exposure of its own row; x to the right as the camera sees it
  std::size_t ball = 0;
  double u = 0, v = 0;   // the centre's projection [px]
  double radius_px = 0;  // of a disc with the silhouette's area
  double visible = 0;    // share of the disc that is seen
  double glare = 0;      // light that the front glass mirrors over its middle, over white; hides what it outshines
  BallState state;
  bool marked = false, tracer = false;
};

struct FilmPicture {
  Image image;
  std::vector<std::uint8_t> coverage;  // share of each pixel that shows balls, over 255
  std::vector<SeenBall> balls;
};

// What a look's camera comes to, for the truth: image point = lens of (camera_from_mill (p - position)), p in R.
struct CameraNumbers {
  Eigen::Matrix3d camera_from_mill;
  Eigen::Vector2d mill_centre;  // of the circle of radius R on the glass [px]
  double mill_radius_px = 0;    // of a disc with the area that this circle has in the picture
};
CameraNumbers camera_numbers(const FilmLens& lens);

// Draws one mill with one look. Aiming anew costs little: programs and buffers stay.
class FilmCamera {
 public:
  FilmCamera();
  ~FilmCamera();
  FilmCamera(const FilmCamera&) = delete;
  FilmCamera& operator=(const FilmCamera&) = delete;

  void aim(const FilmLook& look, const FilmScene& scene);
  // `picture`: number of the picture, for its noise. The exposure is set by the first picture after aim().
  FilmPicture draw(const FilmMoment& moment, std::uint64_t picture);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::render
