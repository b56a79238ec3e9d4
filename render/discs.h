#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "render/palette.h"
#include "render/recorder.h"
#include "render/shader.h"

namespace tumble::render {

struct Disc {
  Eigen::Vector2d centre;  // [px]
  double radius = 0;       // where coverage is one half [px], > 0
  Rgba colour;
  Eigen::Vector2d mark{1, 0};  // unit direction of the painted mark, in the picture
  double mark_strength = 0;    // 0 = no mark, 1 = full
  double gloss = 0.5;          // 0 = painted, 1 = bare steel
};

// Lit balls as instanced quads: the distance to the centre gives the edge (no multisampling) and the normal of a
// sphere, so each ball is shaded as one.
class Discs {
 public:
  Discs(int width, int height);
  void add(const Disc& disc);  // drawn by the next flush(), in the order of adding
  void flush();
  void record_into(Drawing* drawing) { recorder_.record_into(drawing); }  // instead of drawing

 private:
  struct Instance {
    float x, y, radius, mark_x, mark_y, mark_strength, gloss;
    Rgba colour;
  };
  Pipeline pipeline_;
  Recorder recorder_;
  std::vector<Instance> instances_;
};

}  // namespace tumble::render
