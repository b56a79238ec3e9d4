#pragma once
#include <cstddef>

namespace tumble::render {

// What the camera is fixed to: the laboratory; the shell, so that lifter 0 stays at 3 o'clock and gravity turns; or one
// ball, which stays in the middle while up stays up.
struct View {
  enum class From { kLab, kShell, kBall };
  From from = From::kLab;
  std::size_t ball = 0;  // which one, by kBall
  double zoom = 1;       // times as large; beyond 1 the mill is cut off at the view's edges

  bool is_cut() const { return zoom > 1 || from == From::kBall; }
};

}  // namespace tumble::render
