#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/contact_force.h"
#include "core/drawing.h"
#include "core/frame.h"
#include "core/image.h"
#include "render/offscreen_context.h"
#include "render/view.h"

// Front door of render: frame -> image, off-screen. The only room that knows OpenGL.
namespace tumble::render {

enum class Colour { kSpeed, kSize, kSpin, kSteel, kResidence, kForce };
enum class ThemeName { kDark, kLight };  // a screen, paper

struct Overlay {
  bool toe = true, shoulder = true;
  bool tracks = false;    // motion trails of the last moments
  bool velocity = false;  // an arrow a ball
  bool chains = false;    // lines between touching balls, as wide as the normal force

  // Of the run's mean (set_mean):
  bool occupancy = false;      // contours of the share of area that balls cover
  bool streamlines = false;    // equal flow of balls between neighbouring lines
  bool mean_velocity = false;  // arrows on a grid
  bool surface = false;        // the charge's free surface
  bool head = false;
  bool circulation = false;  // its centre
  bool departure = false, impact = false;

  bool text = true;  // clock, speed, torque with its trace, colour bar, scale bar
};

struct Style {
  int width = 1280, height = 720;  // [px], even
  ThemeName theme = ThemeName::kDark;
  Colour colour = Colour::kSpeed;
  Overlay overlay;
  bool mirror = false;  // seen from the other end: the mill turns clockwise
  double slow = 1.0;    // how many times slower than true time; stated in the picture; NaN for a still
  View view;
  ContextKind context = ContextKind::kOsmesa;
};

// Where the film's pictures want to be: a square with the mill's axis in its middle.
struct FilmSquare {
  int edge_px = 0;
  double margin = 0;  // half the edge in mill radii
};

// What of the run such a picture asks for beside its frames.
bool shows_mean(const Overlay& overlay);   // set_mean
bool shows_forces(const Style& style);     // Moment::contacts
bool shows_residence(const Style& style);  // Moment::of_ball

// What surrounds one frame in time: the caller has the whole run, the renderer looks at it.
struct Moment {
  double toe_deg = kNotGiven, shoulder_deg = kNotGiven;  // marks; none where NaN
  std::span<const double> torque_time, torque;  // the trace of the whole run [s], [N m]; the cursor stands at the frame
  std::span<const Frame> past;                  // frames before this one, oldest first, for trails; may be empty
  std::span<const ContactForce> contacts = {};  // for force chains
  std::span<const double> of_ball = {};         // what colours each ball by Colour::kResidence [s] or kForce [N]
};

class Renderer {
 public:
  Renderer(const RunSetup& setup, const Style& style);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Sets the colour scale's ends, e.g. from 0 to the 99th percentile of the whole run's speeds [m/s, rad/s, s or N]. By
  // spin
  // the scale is symmetric, up to the larger of the two; by size from the smallest radius to the largest [m]; by steel
  // there is nothing to set.
  void set_scale(double low, double high);

  // What the overlays of the mean show; without it, or where it knows nothing, they show nothing.
  void set_mean(const ChargeMotion& motion);

  // The normal force that is drawn as the widest chain [N], > 0, e.g. the 99th percentile of the whole run's contacts.
  void set_force_scale(double high);

  // How far back trails reach: what Moment::past should cover [s].
  double trail_seconds() const;

  // The picture; valid until the next draw. Throws WorkError when the context fails.
  const Image& draw(const Frame& frame, const Moment& moment);

  // The same as shapes, for print.
  Drawing sketch(const Frame& frame, const Moment& moment);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::render
