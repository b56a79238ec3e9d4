#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/drawing.h"
#include "core/frame.h"
#include "core/image.h"
#include "render/offscreen_context.h"
#include "render/view.h"

// Front door of render: frame -> image, off-screen. The only room that knows OpenGL.
namespace tumble::render {

enum class Colour { kSpeed, kSize, kSpin, kSteel };

struct Overlay {
  bool toe = true, shoulder = true;
  bool tracks = false;    // motion trails of the last moments
  bool velocity = false;  // arrows
  bool text = true;       // clock, speed, torque with its trace, colour bar, scale bar
};

struct Style {
  int width = 1280, height = 720;  // [px], even
  Colour colour = Colour::kSpeed;
  Overlay overlay;
  bool mirror = false;  // seen from the other end: the mill turns clockwise
  double slow = 1.0;    // how many times slower than true time; stated in the picture; NaN for a still
  View view;
  ContextKind context = ContextKind::kOsmesa;
};

// What surrounds one frame in time: the caller has the whole run, the renderer looks at it.
struct Moment {
  double toe_deg = kNotGiven, shoulder_deg = kNotGiven;  // marks; none where NaN
  std::span<const double> torque_time, torque;  // the trace of the whole run [s], [N m]; the cursor stands at the frame
  std::span<const Frame> past;                  // frames before this one, oldest first, for trails; may be empty
};

class Renderer {
 public:
  Renderer(const RunSetup& setup, const Style& style);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Sets the colour scale's ends, e.g. from 0 to the 99th percentile of the whole run's speeds [m/s or rad/s]. By spin
  // the scale is symmetric, up to the larger of the two; by size from the smallest radius to the largest [m]; by steel
  // there is nothing to set.
  void set_scale(double low, double high);

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
