#include <cmath>

#include "core/units.h"
#include "render/film_sheets.h"

namespace tumble::render {
namespace {

constexpr double kPixels = kDecalSize / 3.0;  // of a decal, per shell radius

Spot at(double radius, double angle) {
  return Spot(kDecalSize / 2.0 - 0.5, kDecalSize / 2.0 - 0.5) +
         radius * kPixels * Spot(std::cos(angle), std::sin(angle));
}

Light scaled_light(const Light& colour, double by) { return colour * static_cast<float>(by); }

void paint_bolt(Sheet& sheet, const Spot& centre, double size, const Light& colour, bool hexagon, double turn) {
  const double r = size * kPixels;
  paint_disc(sheet, {Light(0.01f, 0.01f, 0.01f), 0.6, 0.5 * r}, centre, 1.25 * r);
  if (hexagon) {
    paint_disc(sheet, {scaled_light(colour, 0.7), 1, 1}, centre, 1.1 * r);
    paint_polygon(sheet, {colour, 1, 1}, centre, r, 6, turn);
    paint_disc(sheet, {scaled_light(colour, 0.55), 0.9, 1}, centre, 0.5 * r);
  } else {
    paint_disc(sheet, {colour, 1, 1}, centre, r);
    paint_disc(sheet, {scaled_light(colour, 0.6), 0.8, 1.5}, centre, 0.45 * r);
    paint_ring(sheet, {scaled_light(colour, 1.3), 0.5, 1.5}, centre, 0.8 * r, 0.15 * r);
  }
}

void paint_flange(Sheet& sheet, const FilmLook& look, Random& random) {
  const FlangeLook& flange = look.flange;
  const double middle = 0.5 * (flange.inner + flange.outer), wide = flange.outer - flange.inner;
  const double first = random.uniform(0, 2 * kPi);
  for (int k = 0; k < flange.bolts; ++k) {
    const double angle = first + 2 * kPi * k / flange.bolts;
    paint_bolt(sheet, at(middle, angle), std::min(flange.bolt_size, 0.42 * wide), flange.bolt_colour, flange.hexagons,
               random.uniform(0, kPi));
  }
  if (flange.phase_mark) {
    const double angle = random.uniform(0, 2 * kPi);
    paint_box(sheet, {flange.mark_colour, random.uniform(0.7, 1), 1.5}, at(middle, angle),
              Spot(0.4 * wide, random.uniform(0.06, 0.2) * wide) * kPixels, angle);
  }
  const double angle = random.uniform(0, 2 * kPi);
  const Light ink = chance(random, 0.5) ? Light(0.02f, 0.02f, 0.02f) : Light(0.8f, 0.8f, 0.75f);
  paint_writing(sheet, {ink, 0.8, 1}, at(middle, angle), Spot(-std::sin(angle), std::cos(angle)), 0.35 * wide * kPixels,
                flange.letters, random);
}

void paint_decoys(Sheet& sheet, const FilmLook& look, double ball_radius, Random& random) {
  for (int k = 0; k < look.plate.decoys; ++k) {
    const Spot where = at(0.95 * std::sqrt(random.uniform()), random.uniform(0, 2 * kPi));
    const double r = ball_radius * kPixels * random.uniform(0.6, 1.4);
    const auto grey = static_cast<float>(random.uniform(0.01, 0.6));
    const Paint with{look.plate.surface.colour * 0.3f + Light(grey, grey, grey) * 0.7f, random.uniform(0.3, 1), 1.5};
    if (chance(random, 0.5))
      paint_ring(sheet, with, where, r, random.uniform(0.1, 0.4) * r);
    else
      paint_disc(sheet, with, where, r);
  }
}

void paint_plate(Sheet& sheet, const FilmLook& look, double ball_radius, Random& random) {
  const PlateLook& plate = look.plate;
  const Light own = plate.surface.colour;
  if (plate.lines) {
    const double angle = random.uniform(0, kPi);
    const Light ink = own.sum() > 0.9f ? Light(0.02f, 0.02f, 0.02f) : Light(0.7f, 0.7f, 0.7f);
    const Paint with{ink, random.uniform(0.3, 0.9), 1.5};
    const double width = random.uniform(0.005, 0.03) * kPixels;
    paint_stroke(sheet, with, at(0.98, angle), chance(random, 0.5) ? at(0.98, angle + kPi) : at(0, 0), width);
    if (chance(random, 0.5)) paint_stroke(sheet, with, at(0.98, angle + kPi / 2), at(0.98, angle - kPi / 2), width);
  }
  if (plate.hub > 0) {
    paint_disc(sheet, {scaled_light(own, random.uniform(0.5, 1.5)), random.uniform(0.2, 1), 2}, at(0, 0),
               plate.hub * kPixels);
    paint_ring(sheet, {scaled_light(own, 0.2), 0.8, 1.5}, at(0, 0), plate.hub * kPixels, 0.012 * kPixels);
    for (int k = 0; k < plate.bolts; ++k)
      paint_bolt(sheet, at(0.7 * plate.hub, 2 * kPi * k / plate.bolts), 0.11 * plate.hub, scaled_light(own, 1.2), false,
                 0);
  }
  for (int line = 0; plate.letters > 0 && line < 2; ++line) {
    const double angle = random.uniform(0, 2 * kPi);
    const Light ink = chance(random, 0.6) ? Light(0.02f, 0.02f, 0.02f) : Light(0.8f, 0.8f, 0.8f);
    paint_writing(sheet, {ink, random.uniform(0.3, 0.9), 1}, at(random.uniform(0.3, 0.8), angle),
                  Spot(-std::sin(angle), std::cos(angle)), random.uniform(0.04, 0.1) * kPixels, plate.letters, random);
  }
  paint_decoys(sheet, look, ball_radius, random);
}

}  // namespace

Sheet paint_decals(const FilmLook& look, double ball_radius) {
  Sheet sheet(kDecalSize, kDecalSize);
  Random random(look.seed * 31 + 5);
  paint_plate(sheet, look, ball_radius, random);
  if (look.flange.there) paint_flange(sheet, look, random);
  return sheet;
}

Sheet paint_glass(const FilmLook& look) {
  Sheet sheet(kDecalSize, kDecalSize);
  Random random(look.seed * 37 + 11);
  const GlassLook& glass = look.glass;
  if (glass.smudges > 0) {
    const int count = 2 + static_cast<int>(random.below(5));
    for (int k = 0; k < count; ++k) {
      const Spot half = Spot(random.uniform(0.08, 0.35), random.uniform(0.03, 0.2)) * kPixels;
      const auto milk = static_cast<float>(glass.smudges * random.uniform(0.2, 1.0));
      add_glow(sheet, Light(milk, milk, milk), at(random.uniform(0, 0.95), random.uniform(0, 2 * kPi)), half,
               random.uniform(0, kPi));
    }
    for (int k = 0; k < 60; ++k)
      paint_disc(sheet, {Light(0.3f, 0.3f, 0.3f), std::min(0.8, 4 * glass.smudges), 1.5},
                 at(std::sqrt(random.uniform()), random.uniform(0, 2 * kPi)), random.uniform(0.5, 2));
  }
  for (int k = 0; k < glass.scratches; ++k) {
    const double radius = std::sqrt(random.uniform()), angle = random.uniform(0, 2 * kPi);
    const double to = angle + random.uniform(-0.5, 0.5), out = std::min(1.0, radius + random.uniform(-0.1, 0.1));
    const auto white = static_cast<float>(random.uniform(0.3, 1.0));
    std::vector<Spot> points;
    for (int i = 0; i <= 8; ++i)
      points.push_back(at(radius + i / 8.0 * (out - radius), angle + i / 8.0 * (to - angle)));
    paint_line(sheet, {Light(white, white, white), glass.scratch, 1.2}, points, random.uniform(0.4, 1.4));
  }
  return sheet;
}

}  // namespace tumble::render
