#include "render/film_sheets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/units.h"

namespace tumble::render {
namespace {

Light grey(double value) {
  const auto g = static_cast<float>(value);
  return {g, g, g};
}

Light any_colour(Random& random, double brightness) {
  Light c(static_cast<float>(random.uniform()), static_cast<float>(random.uniform()),
          static_cast<float>(random.uniform()));
  c = c * 0.6f + grey(0.4 * c.mean());
  return c * static_cast<float>(brightness / std::max(0.05, double(c.mean())));
}

// The room's own sheet has half the picture's size: it is out of focus anyway.
struct RoomPainter {
  const FilmLook& look;
  Sheet sheet;
  Random random;
  Spot mill;      // [px of the sheet]
  double radius;  // R [px of the sheet]
  double soft;

  double x() { return random.uniform(0, sheet.width); }
  double y(double from, double to) { return random.uniform(from, to) * sheet.height; }
  double floor_row() const { return look.room.floor_at * sheet.height; }
};

void paint_walls(RoomPainter& my) {
  const RoomLook& room = my.look.room;
  const double slope_x = my.random.uniform(-1, 1) * room.uneven, slope_y = my.random.uniform(-1, 1) * room.uneven;
  const std::uint64_t seed = my.random.next();
  const double shade_x = my.random.uniform(-0.15, 0.15) * my.radius, shade_y = my.random.uniform(0, 0.25) * my.radius;
  const double shade = my.random.uniform(0, 0.5);
  for (int j = 0; j < my.sheet.height; ++j) {
    for (int i = 0; i < my.sheet.width; ++i) {
      const double x = double(i) / my.sheet.width - 0.5, y = double(j) / my.sheet.height - 0.5;
      const double below = std::clamp((j - my.floor_row()) / my.soft + 0.5, 0.0, 1.0);
      double light = 1 + slope_x * x * 2 + slope_y * y * 2 +
                     0.3 * room.uneven * (smooth_noise(4 * x + 8, 4 * y + 8, 64, seed) - 0.5);
      const double off = std::hypot(i - my.mill.x() - shade_x, j - my.mill.y() - shade_y) / my.radius;
      light *= 1 - shade * std::exp(-std::max(0.0, off - 1) * 4);
      light *= 1 - 0.25 * std::exp(-std::abs(j - my.floor_row()) / (6 * my.soft));
      const Light c = (room.wall * static_cast<float>(1 - below) + room.floor * static_cast<float>(below)) *
                      static_cast<float>(std::max(0.05, light));
      float* p = my.sheet.at(i, j);
      for (int k = 0; k < 3; ++k) p[k] = c[k];
      p[3] = 1;
    }
  }
}

void paint_clutter(RoomPainter& my) {
  const RoomLook& room = my.look.room;
  const double size = my.sheet.height;
  Random& random = my.random;
  for (int k = 0; k < room.rectangles; ++k) {
    const Spot where(my.x(), my.y(0, 0.95)), half = Spot(random.uniform(0.02, 0.14), random.uniform(0.02, 0.14)) * size;
    const double angle = chance(random, 0.8) ? 0 : random.uniform(-0.5, 0.5);
    paint_box(my.sheet, {any_colour(random, log_uniform(random, 0.02, 0.6)), random.uniform(0.5, 1), my.soft}, where,
              half, angle);
    if (chance(random, 0.4))
      paint_box(my.sheet, {any_colour(random, log_uniform(random, 0.02, 0.6)), random.uniform(0.3, 1), my.soft}, where,
                half * random.uniform(0.3, 0.8), angle);
    if (chance(random, 0.2))
      paint_writing(my.sheet, {grey(random.uniform(0, 0.8)), 0.8, my.soft}, where, Spot(1, 0), 0.03 * size, 5, random);
  }
  for (int k = 0; k < room.cables; ++k) {
    std::vector<Spot> points{Spot(my.x(), my.y(0, 0.9))};
    double angle = random.uniform(0, 2 * kPi);
    const Paint with{any_colour(random, log_uniform(random, 0.005, 0.2)), random.uniform(0.5, 1), my.soft};
    const double width = random.uniform(0.004, 0.02) * size, bend = random.uniform(-0.3, 0.3);
    for (int i = 0; i < 12; ++i) {
      points.push_back(points.back() + 0.05 * size * Spot(std::cos(angle), std::sin(angle)));
      angle += bend + random.uniform(-0.3, 0.3);
    }
    paint_line(my.sheet, with, points, width);
  }
}

// A ball that lies about: a disc with light from above.
void paint_loose_ball(RoomPainter& my, const Spot& where, double r, double soft, const Light& colour) {
  paint_disc(my.sheet, {colour * 0.2f, 1, soft}, where, r);
  paint_disc(my.sheet, {colour, 0.9, std::max(soft, 0.7 * r)}, where + Spot(-0.12, -0.2) * r, 0.7 * r);
  paint_disc(my.sheet, {grey(0.9), 0.7, soft}, where + Spot(-0.3, -0.4) * r, 0.18 * r);
}

void paint_discs(RoomPainter& my, double ball_px) {
  const RoomLook& room = my.look.room;
  Random& random = my.random;
  const Light ball_colour = my.look.balls.materials.front().colour;
  for (int k = 0; k < room.discs; ++k) {
    const Spot where(my.x(), my.y(0, 1));
    const double r =
        chance(random, 0.5) ? ball_px * random.uniform(0.7, 2) : random.uniform(0.01, 0.06) * my.sheet.height;
    const double soft = std::min(my.soft, 0.8 * r);
    if (chance(random, 0.4)) {
      paint_loose_ball(my, where, r, soft, ball_colour);
    } else {
      const Light colour = any_colour(random, log_uniform(random, 0.02, 0.7));
      paint_disc(my.sheet, {colour, 1, soft}, where, r);
      paint_ring(my.sheet, {colour * 0.4f, 0.8, soft}, where, 0.8 * r, 0.15 * r);
      if (chance(random, 0.5))
        paint_stroke(my.sheet, {grey(0.02), 0.9, soft}, where, where + Spot(0.6, -0.4) * r, 0.1 * r);
    }
  }
  for (int k = 0; k < room.heaps; ++k) {
    const double x = my.x(), soft = std::min(my.soft, 0.8 * ball_px);
    const int count = 4 + static_cast<int>(random.below(14));
    for (int i = 0; i < count; ++i) {
      const double up = std::abs(gaussian(random)) * 0.8;
      paint_loose_ball(my, Spot(x + gaussian(random) * 4 * ball_px, my.floor_row() + (1 - 2 * up) * ball_px), ball_px,
                       soft, ball_colour);
    }
  }
}

void paint_stand(RoomPainter& my) {
  const RoomLook& room = my.look.room;
  Random& random = my.random;
  const double r = my.radius, soft = std::max(1.0, 0.6 * my.soft);
  if (room.stand) {
    const double width = random.uniform(0.06, 0.2) * r, foot = random.uniform(0.6, 1.3) * r;
    for (const double side : {-1.0, 1.0})
      paint_stroke(my.sheet, {room.stand_colour, 1, soft}, my.mill + Spot(side * 0.4 * r, 0.6 * r),
                   Spot(my.mill.x() + side * foot, std::max(my.floor_row(), my.mill.y() + 1.5 * r)), width);
    if (chance(random, 0.5))
      paint_box(my.sheet, {room.stand_colour * 1.2f, 1, soft}, my.mill + Spot(0, 1.45 * r), Spot(foot, 0.1 * r), 0);
  }
  if (room.wheels) {
    for (const double side : {-1.0, 1.0}) {
      const double w = random.uniform(0.2, 0.4) * r, out = (my.look.flange.there ? my.look.flange.outer : 1.05) * r + w;
      const double angle = random.uniform(0.6, 0.9);
      const Spot hub = my.mill + out * Spot(side * std::sin(angle), std::cos(angle));
      paint_disc(my.sheet, {grey(0.01), 1, soft}, hub, w);
      const Light rim = any_colour(random, 0.3);
      paint_ring(my.sheet, {rim, 1, soft}, hub, 0.65 * w, 0.08 * w);
      for (int k = 0; k < 9; ++k) {
        const double a = 2 * kPi * k / 9;
        paint_stroke(my.sheet, {rim, 1, soft}, hub, hub + 0.65 * w * Spot(std::cos(a), std::sin(a)), 0.09 * w);
      }
      paint_disc(my.sheet, {grey(0.5), 1, soft}, hub, 0.1 * w);
    }
  }
  if (room.display) {
    const Spot where(my.x(), my.y(0.75, 0.95));
    const double h = random.uniform(0.03, 0.06) * my.sheet.height;
    paint_box(my.sheet, {grey(0.03), 1, soft}, where, Spot(2.2 * h, 1.2 * h), 0);
    paint_writing(my.sheet, {Light(1.2f, 0.1f, 0.05f), 1, 1.5}, where + Spot(-1.2 * h, 0.6 * h), Spot(1, 0), 1.2 * h, 3,
                  random);
  }
}

}  // namespace

Sheet paint_room(const FilmLook& look, const MillPlace& place, double ball_radius) {
  RoomPainter my{look,
                 Sheet((look.lens.width + 1) / 2, (look.lens.height + 1) / 2),
                 Random(look.seed * 41 + 3),
                 place.centre / 2,
                 place.radius / 2,
                 std::max(1.0, look.room.defocus / 2)};
  paint_walls(my);
  paint_clutter(my);
  paint_stand(my);
  paint_discs(my, ball_radius * place.radius / 2);
  return std::move(my.sheet);
}

Sheet paint_front(const FilmLook& look, const MillPlace& place) {
  Sheet sheet(look.lens.width, look.lens.height);
  Random random(look.seed * 43 + 17);
  const double soft = 1.2 + random.uniform(0, 2);
  for (const Bar& bar : look.front.bars) {
    const Spot along(std::cos(bar.angle), -std::sin(bar.angle)), across(along.y(), -along.x());
    const Spot middle = place.centre + across * (bar.offset * place.radius);
    const double half = 0.5 * bar.width * place.radius, begin = bar.begin * place.radius, end = bar.end * place.radius;
    // Three strips, so that the bar has a lit and a dark edge.
    const Spot centre = middle + along * (0.5 * (begin + end));
    const Spot size(0.5 * (end - begin), half);
    paint_box(sheet, {bar.colour, 1, soft}, centre, size, -bar.angle);
    paint_box(sheet, {bar.colour * 1.7f, 0.7, 0.6 * half}, centre + across * (0.45 * half), Spot(size.x(), 0.25 * half),
              -bar.angle);
    paint_box(sheet, {bar.colour * 0.35f, 0.7, 0.5 * half}, centre - across * (0.7 * half), Spot(size.x(), 0.2 * half),
              -bar.angle);
    for (int k = 0; k < 4; ++k)
      if (chance(random, 0.3))
        paint_disc(sheet, {bar.colour * 0.4f, 0.9, soft}, middle + along * (random.uniform(-1, 1) * place.radius),
                   0.3 * half);
  }
  if (look.front.hub > 0) {
    const double r = look.front.hub * place.radius;
    const Light c = look.front.hub_colour;
    paint_disc(sheet, {c * 0.3f, 1, soft}, place.centre, r);
    paint_disc(sheet, {c, 1, 0.4 * r}, place.centre + Spot(-0.08, -0.1) * r, 0.82 * r);
    paint_ring(sheet, {c * 0.25f, 0.9, soft}, place.centre, 0.62 * r, 0.1 * r);
    const int rollers = 7 + static_cast<int>(random.below(6));
    for (int k = 0; k < rollers; ++k) {
      const double a = 2 * kPi * k / rollers;
      paint_disc(sheet, {c * 1.5f, 0.9, soft}, place.centre + 0.62 * r * Spot(std::cos(a), std::sin(a)), 0.09 * r);
    }
    paint_disc(sheet, {c * 0.6f, 1, soft}, place.centre, 0.36 * r);
    paint_disc(sheet, {c * 1.6f, 1, 0.2 * r}, place.centre, 0.2 * r);
  }
  return sheet;
}

Sheet paint_glare(const FilmLook& look, const MillPlace& place) {
  constexpr double kShare = 0.25;
  Sheet sheet((look.lens.width + 3) / 4, (look.lens.height + 3) / 4);
  Random random(look.seed * 47 + 23);
  const Spot mill = place.centre * kShare;
  const double r = place.radius * kShare;
  const auto somewhere = [&]() -> Spot {
    const double out = std::sqrt(random.uniform()) * r, angle = random.uniform(0, 2 * kPi);
    return mill + out * Spot(std::cos(angle), std::sin(angle));
  };
  for (int k = 0; k < look.glass.glares; ++k) {
    const bool streak = chance(random, 0.5);
    const Spot half =
        Spot(random.uniform(0.1, 0.6), streak ? random.uniform(0.01, 0.05) : random.uniform(0.08, 0.4)) * r;
    add_glow(sheet, grey(look.glass.glare * log_uniform(random, 0.2, 1)), somewhere(), half.cwiseMax(Spot(0.7, 0.7)),
             random.uniform(0, kPi));
  }
  for (int k = 0; k < look.glass.windows; ++k) {
    const Spot half = Spot(random.uniform(0.05, 0.3), random.uniform(0.05, 0.3)) * r;
    const double angle = random.uniform(-0.4, 0.4);
    const Spot where = somewhere();
    const double light = look.glass.window * log_uniform(random, 0.3, 1);
    const int panes = 1 + static_cast<int>(random.below(3));
    for (int i = 0; i < panes; ++i) {
      Sheet pane(sheet.width, sheet.height);
      paint_box(pane, {grey(1), 1, random.uniform(0.8, 4)},
                where + Spot(std::cos(angle), std::sin(angle)) * (2.2 * half.x() * i), half, angle);
      for (std::size_t n = 0; n < sheet.rgba.size(); ++n) sheet.rgba[n] += static_cast<float>(light) * pane.rgba[n];
    }
  }
  // Only the glass mirrors: nothing outside the mill.
  const double edge = (look.flange.there ? look.flange.inner : 1.0) * r;
  for (int j = 0; j < sheet.height; ++j)
    for (int i = 0; i < sheet.width; ++i) {
      const auto keep = static_cast<float>(std::clamp(edge - (Spot(i, j) - mill).norm() + 0.5, 0.0, 1.0));
      for (int c = 0; c < 4; ++c) sheet.at(i, j)[c] *= keep;
    }
  return sheet;
}

namespace {

// Ten digits and a colon of 3 x 5 dots, a row in three bits.
constexpr std::array<std::array<int, 5>, 11> kDigits = {{{7, 5, 5, 5, 7},
                                                         {2, 6, 2, 2, 7},
                                                         {7, 1, 7, 4, 7},
                                                         {7, 1, 7, 1, 7},
                                                         {5, 5, 7, 1, 1},
                                                         {7, 4, 7, 1, 7},
                                                         {7, 4, 7, 5, 7},
                                                         {7, 1, 2, 2, 2},
                                                         {7, 5, 7, 5, 7},
                                                         {7, 5, 7, 1, 7},
                                                         {0, 2, 0, 2, 0}}};

void write_digits(Sheet& sheet, const Paint& with, const std::string& text, const Spot& begin, double dot) {
  double x = begin.x();
  for (const char c : text) {
    const auto& sign = kDigits[c == ':' ? 10 : static_cast<std::size_t>(c - '0')];
    for (int row = 0; row < 5; ++row)
      for (int column = 0; column < 3; ++column)
        if (sign[static_cast<std::size_t>(row)] >> (2 - column) & 1)
          paint_box(sheet, with, Spot(x + column * dot, begin.y() + row * dot), Spot(dot / 2, dot / 2), 0);
    x += 4 * dot;
  }
}

}  // namespace

void write_overlay(Sheet& sheet, const FilmLook& look, double time) {
  Random random(look.seed * 53 + 29);
  const double size = look.lens.height;
  const bool boxed = chance(random, 0.4);
  const auto corner = [&](double length, double height) -> Spot {
    const double margin = 0.03 * size;
    const Spot at(chance(random, 0.5) ? margin : std::max(margin, look.lens.width - margin - length),
                  chance(random, 0.5) ? margin : size - margin - height);
    if (boxed)
      paint_box(sheet, {grey(0), 0.7, 1}, at + Spot(length, height) / 2, Spot(length, height) / 2 + Spot(4, 4), 0);
    return at;
  };
  const Light ink = chance(random, 0.6) ? grey(1) : any_colour(random, 0.6);
  if (look.overlay.clock) {
    const double dot = random.uniform(0.004, 0.011) * size;
    const int hundredths = static_cast<int>(std::max(0.0, time) * 100 + 0.5);
    const Spot at = corner(8 * 4 * dot, 5 * dot);
    write_digits(sheet, {ink, 1, 1},
                 fmt::format("{:02}:{:02}:{:02}", hundredths / 6000 % 100, hundredths / 100 % 60, hundredths % 100), at,
                 dot);
  }
  for (int k = 0; k < look.overlay.words; ++k) {
    const double height = random.uniform(0.015, 0.04) * size;
    const int signs = 3 + static_cast<int>(random.below(16));
    const Spot at = chance(random, 0.7) ? corner(signs * 0.8 * height, height)
                                        : Spot(random.uniform(0, look.lens.width), random.uniform(0, size));
    paint_writing(sheet, {ink, random.uniform(0.5, 1), 1}, at + Spot(0, height), Spot(1, 0), height, signs, random);
  }
}

}  // namespace tumble::render
