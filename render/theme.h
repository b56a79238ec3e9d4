#pragma once
#include "render/palette.h"
#include "render/renderer.h"

namespace tumble::render {

// All inks of a picture, so that it can stand on a dark screen or on paper. Whatever is text keeps 4.5:1 on what it is
// written on (WCAG 2.1, level AA).
struct Theme {
  Rgba ground, mill_inside;
  Rgba steel;                   // of balls and shell
  Rgba text;                    // values, titles
  Rgba quiet;                   // labels, axes
  Rgba faint;                   // rules, frames
  Rgba accent;                  // toe, shoulder, cursor
  Rgba second;                  // departure, impact, head, centre of circulation: what flies and turns
  Rgba trace;                   // the torque's line
  Rgba halo;                    // outline of what is drawn over balls
  Rgba force;                   // force chains
  Rgba flow;                    // streamlines
  double plate_brightness = 1;  // of the shell's steel
  Palette magnitude;            // lightness goes one way all along, away from the ground's
  Palette of_sign;              // pale in the middle
};

const Theme& dark_theme();
const Theme& light_theme();
const Theme& theme_of(const Style& style);

// Contrast of two opaque colours, 1 to 21 (WCAG 2.1: relative luminances, each with 0.05 of stray light).
double contrast(Rgba a, Rgba b);

}  // namespace tumble::render
