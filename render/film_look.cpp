#include "render/film_look.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.h"
#include "core/units.h"
#include "render/paint.h"

namespace tumble::render {
namespace {

Light grey(double value) {
  const auto g = static_cast<float>(value);
  return {g, g, g};
}

// A grey of this brightness with a cast.
Light tinted(Random& random, double value, double cast) {
  Light c;
  for (int k = 0; k < 3; ++k) c[k] = static_cast<float>(value * std::exp(cast * gaussian(random)));
  return c.cwiseMin(1.2f);
}

// A saturated colour by its hue in [0, 1).
Light paint_of(double hue, double value) {
  Light c;
  for (int k = 0; k < 3; ++k) {
    const double x = std::abs(std::fmod(6 * hue + 6 - 2 * k, 6.0) - 3) - 1;
    c[k] = static_cast<float>(value * (0.04 + 0.96 * std::clamp(x, 0.0, 1.0)));
  }
  return c;
}

double radians_of(double degrees) { return degrees * kPi / 180; }

// Between what a clean film has and what a nasty one has.
double by_level(int level, double clean, double nasty) { return clean + (nasty - clean) * level / 3.0; }

FilmLens random_lens(Random& random, int level) {
  FilmLens lens;
  const double off_axis = radians_of(level == 0 ? random.uniform(0, 1) : random.uniform(0, by_level(level, 0, 13)));
  const double round = random.uniform(0, 2 * kPi), distance = log_uniform(random, by_level(level, 6, 3), 14);
  lens.position = distance * Eigen::Vector3d(std::sin(off_axis) * std::cos(round), std::sin(off_axis) * std::sin(round),
                                             std::cos(off_axis));
  lens.yaw = std::atan2(-lens.position.x(), lens.position.z());
  lens.pitch = -std::asin(lens.position.y() / distance);
  lens.roll = level == 0 ? 0 : radians_of(gaussian(random) * by_level(level, 0, 3));
  if (level > 0) {
    lens.k1 = random.uniform(-0.3, 0.12) * by_level(level, 0.2, 1);
    lens.k2 = random.uniform(-0.05, 0.1) * by_level(level, 0, 1);
  }
  return lens;
}

FilmTiming random_timing(Random& random, int level) {
  FilmTiming timing;
  timing.exposure = log_uniform(random, 0.0003, by_level(level, 0.0015, 0.009));
  timing.readout = level == 0 || chance(random, 0.3) ? 0 : random.uniform(0.001, by_level(level, 0.004, 0.02));
  if (level > 1 && chance(random, 0.4)) timing.flicker = random.uniform(0.02, 0.3);
  timing.flicker_hz = chance(random, 0.5) ? 100 : 120;
  timing.flicker_phase = random.uniform(0, 2 * kPi);
  return timing;
}

FilmSensor random_sensor(Random& random, int level) {
  FilmSensor sensor;
  sensor.level = log_uniform(random, by_level(level, 0.35, 0.12), by_level(level, 0.8, 1.5));
  sensor.blur = log_uniform(random, 0.35, by_level(level, 0.7, 1.8));
  sensor.shot = log_uniform(random, 1e-5, by_level(level, 4e-4, 4e-3));
  sensor.read = log_uniform(random, 5e-4, by_level(level, 3e-3, 1.2e-2));
  sensor.grain = chance(random, 0.6) ? random.uniform(0, 0.9) : 0;
  sensor.sharpening = chance(random, 0.6) ? random.uniform(0, by_level(level, 0.5, 1.6)) : 0;
  sensor.vignette = random.uniform(0, by_level(level, 0.15, 0.5));
  sensor.tilt_x = random.uniform(-1, 1) * by_level(level, 0.1, 0.7);
  sensor.tilt_y = random.uniform(-1, 1) * by_level(level, 0.1, 0.7);
  sensor.gamma = random.uniform(1.7, 2.6);
  sensor.contrast = random.uniform(-0.3, 0.6) * by_level(level, 0.4, 1);
  sensor.saturation = chance(random, 0.1) ? 0 : random.uniform(0.6, 1.4);
  sensor.white = tinted(random, 1, by_level(level, 0.04, 0.12));
  sensor.haze = chance(random, 0.3) ? random.uniform(0, by_level(level, 0.02, 0.15)) : 0;
  return sensor;
}

std::vector<Lamp> random_lamps(Random& random, int level) {
  std::vector<Lamp> lamps;
  const bool two = chance(random, 0.5);
  for (int k = 0; k < (two ? 2 : 1); ++k) {
    Lamp lamp;
    const double up = random.uniform(-0.2, 1), off = random.uniform(0.15, by_level(level, 0.8, 1.3));
    const double side = std::atan2(up, random.uniform(-1, 1));
    lamp.towards = {std::sin(off) * std::cos(side), std::sin(off) * std::sin(side), std::cos(off)};
    lamp.colour = tinted(random, k == 0 ? random.uniform(0.5, 1.4) : random.uniform(0.15, 0.8), 0.08);
    lamp.size = log_uniform(random, 0.03, 0.6);
    lamps.push_back(lamp);
  }
  return lamps;
}

// What mills are charged with, and what is taken instead in teaching mills.
BallMaterial random_material(Random& random, int level, bool only_steel) {
  BallMaterial m;
  switch (random.below(only_steel ? 3 : 8)) {
    case 0:
    case 1:  // bright steel
      m = {tinted(random, random.uniform(0.45, 0.8), 0.03), random.uniform(0.6, 1), random.uniform(0.3, 1),
           random.uniform(0.12, 0.4)};
      break;
    case 2:  // worn, dark steel
      m = {tinted(random, log_uniform(random, 0.05, 0.35), 0.06), random.uniform(0.2, 0.7), random.uniform(0.1, 0.5),
           random.uniform(0.3, 0.7)};
      break;
    case 3:  // rusty or sandy
      m = {Light(0.3f, 0.2f, 0.13f) * static_cast<float>(random.uniform(0.4, 1.3)), random.uniform(0, 0.3),
           random.uniform(0, 0.3), random.uniform(0.4, 0.9)};
      m.rust = random.uniform(0, 0.6);
      break;
    case 4:  // ceramic, chalk, white plastic
      m = {tinted(random, random.uniform(0.5, 0.95), 0.05), 0, random.uniform(0.05, 0.6), random.uniform(0.15, 0.7)};
      break;
    case 5:  // glass
      m = {tinted(random, random.uniform(0.1, 0.5), 0.25), random.uniform(0.1, 0.5), random.uniform(0.5, 1.3),
           random.uniform(0.08, 0.2)};
      m.translucent = random.uniform(0.3, 1.2);
      break;
    case 6:  // coloured plastic
      m = {paint_of(random.uniform(), random.uniform(0.15, 0.8)), random.uniform(0, 0.2), random.uniform(0.1, 0.7),
           random.uniform(0.15, 0.5)};
      break;
    default:  // brass, bronze, copper
      m = {Light(0.7f, 0.48f, 0.25f) * static_cast<float>(random.uniform(0.4, 1.2)), random.uniform(0.6, 1),
           random.uniform(0.3, 1), random.uniform(0.15, 0.45)};
  }
  m.variation = random.uniform(0, by_level(level, 0.08, 0.4));
  m.dirt = random.uniform(0, by_level(level, 0.2, 0.9));
  if (chance(random, by_level(level, 0, 0.3))) m.rust = random.uniform(0, 0.5);
  return m;
}

BallLook random_balls(Random& random, int level, bool only_steel) {
  BallLook balls;
  balls.materials.clear();
  const int kinds = chance(random, 0.6) ? 1 : 2 + static_cast<int>(random.below(3));
  for (int k = 0; k < kinds; ++k) balls.materials.push_back(random_material(random, level, only_steel));
  // Often the same stuff, only older or newer.
  if (kinds > 1 && chance(random, 0.5))
    for (BallMaterial& m : balls.materials) {
      const BallMaterial& first = balls.materials.front();
      const auto by = static_cast<float>(log_uniform(random, 0.3, 1.4));
      m = first;
      m.colour = (first.colour * by).cwiseMin(1.f);
      m.rust = random.uniform(0, 0.3);
    }
  balls.by_class = chance(random, 0.4);
  constexpr std::array kMarks = {BallMark::kLine, BallMark::kHalf, BallMark::kDots};
  if (chance(random, 0.55)) {
    balls.mark = kMarks[random.below(3)];
    balls.marked_share = chance(random, 0.5) ? 1 : random.uniform(0.03, 0.6);
  }
  const double shade = balls.materials.front().colour.mean();
  balls.mark_colour = chance(random, 0.3)   ? paint_of(random.uniform(), random.uniform(0.3, 0.9))
                      : shade > 0.5         ? grey(random.uniform(0, 0.08))
                      : chance(random, 0.8) ? grey(random.uniform(0.6, 1))
                                            : grey(random.uniform(0, 0.1));
  balls.mark_width = random.uniform(0.07, 0.25);
  balls.mark_tilt = level == 0 ? 0 : random.uniform(0, by_level(level, 0.05, 0.4));
  if (chance(random, only_steel ? 0.05 : 0.25)) {
    const int count = 1 + static_cast<int>(random.below(5));
    for (int k = 0; k < count; ++k) balls.paints.push_back(paint_of(random.uniform(), random.uniform(0.2, 0.9)));
    balls.painted_share = random.uniform(0.1, 1);
  }
  if (chance(random, 0.6)) {
    const int count = 1 + static_cast<int>(random.below(5));
    for (int k = 0; k < count; ++k) balls.tracers.push_back(paint_of(random.uniform(), random.uniform(0.3, 1)));
  }
  balls.hollow_share = chance(random, 0.15) ? random.uniform(0.1, 0.9) : 0;
  balls.hole = random.uniform(0.2, 0.45);
  balls.occlusion = random.uniform(0.3, 0.9);
  balls.depth_fade = random.uniform(0.1, 0.8);
  return balls;
}

Surface random_surface(Random& random, int level, double darkest, double brightest) {
  Surface s;
  const double value = log_uniform(random, darkest, brightest);
  s.colour = chance(random, 0.75) ? tinted(random, value, 0.06)
                                  : paint_of(random.uniform(), value).cwiseMax(0.1f * grey(value));
  s.gloss = random.uniform(0, by_level(level, 0.3, 0.7));
  s.roughness = random.uniform(0.25, 0.8);
  s.brushed = chance(random, 0.6) ? random.uniform(0.1, 0.9) : 0;
  s.blotches = random.uniform(0, by_level(level, 0.2, 0.6));
  s.grain = random.uniform(0, by_level(level, 0.1, 0.5));
  if (chance(random, by_level(level, 0.2, 0.7))) s.rust = random.uniform(0.05, by_level(level, 0.3, 0.8));
  s.rust_colour = Light(0.25f, 0.11f, 0.05f) * static_cast<float>(random.uniform(0.4, 1.8));
  return s;
}

FlangeLook random_flange(Random& random, int level) {
  FlangeLook flange;
  flange.there = chance(random, 0.9);
  flange.inner = chance(random, 0.6) ? random.uniform(0.985, 1.005) : random.uniform(1.005, 1.04);
  flange.outer = flange.inner + random.uniform(0.04, 0.25);
  flange.thick = random.uniform(0.004, 0.06);
  flange.surface = random_surface(random, level, 0.02, 0.8);
  flange.bolts = chance(random, 0.2) ? 0 : 4 + static_cast<int>(random.below(24));
  flange.bolt_size = random.uniform(0.01, 0.045);
  flange.hexagons = chance(random, 0.5);
  flange.bolt_colour = chance(random, 0.6) ? grey(random.uniform(0.3, 0.9))
                                           : flange.surface.colour * static_cast<float>(random.uniform(0.5, 1.3));
  flange.phase_mark = chance(random, 0.6);
  flange.mark_colour = chance(random, 0.6) ? grey(random.uniform(0.6, 1)) : paint_of(random.uniform(), 0.7);
  flange.letters = chance(random, by_level(level, 0.1, 0.5)) ? 3 + static_cast<int>(random.below(14)) : 0;
  return flange;
}

PlateLook random_plate(Random& random, int level) {
  PlateLook plate;
  plate.surface = random_surface(random, level, 0.01, 0.95);
  plate.hub = chance(random, 0.55) ? random.uniform(0.05, 0.3) : 0;
  plate.bolts = static_cast<int>(random.below(9));
  plate.letters = chance(random, by_level(level, 0.05, 0.4)) ? 2 + static_cast<int>(random.below(12)) : 0;
  plate.decoys = chance(random, by_level(level, 0, 0.5)) ? 1 + static_cast<int>(random.below(12)) : 0;
  plate.lines = chance(random, by_level(level, 0.05, 0.3));
  return plate;
}

GlassLook random_glass(Random& random, int level) {
  GlassLook glass;
  if (level == 0) return glass;
  if (chance(random, by_level(level, 0.2, 0.7))) {
    glass.glares = 1 + static_cast<int>(random.below(4));
    glass.glare = log_uniform(random, 0.03, by_level(level, 0.1, 0.9));
  }
  if (chance(random, by_level(level, 0.05, 0.4))) {
    glass.windows = 1 + static_cast<int>(random.below(2));
    glass.window = log_uniform(random, 0.02, by_level(level, 0.1, 0.6));
  }
  if (chance(random, by_level(level, 0.1, 0.6))) {
    glass.scratches = 3 + static_cast<int>(random.below(30));
    glass.scratch = random.uniform(0.05, by_level(level, 0.2, 0.7));
  }
  if (chance(random, by_level(level, 0.1, 0.6))) glass.smudges = random.uniform(0.01, by_level(level, 0.05, 0.2));
  return glass;
}

RoomLook random_room(Random& random, int level) {
  RoomLook room;
  room.wall = tinted(random, log_uniform(random, 0.01, 0.9), 0.15);
  room.floor = tinted(random, log_uniform(random, 0.01, 0.6), 0.3);
  room.floor_at = random.uniform(0.75, 1.15);
  room.uneven = random.uniform(0, 0.8);
  const auto some = [&](double most) {
    return static_cast<int>(random.uniform(0, by_level(level, 0.3, 1) * most + 1));
  };
  room.rectangles = some(10);
  room.cables = some(6);
  room.discs = some(10);
  room.heaps = some(2.5);
  room.stand = chance(random, 0.6);
  room.wheels = chance(random, 0.3);
  room.display = chance(random, 0.3);
  room.stand_colour = tinted(random, log_uniform(random, 0.01, 0.4), 0.5);
  room.defocus = log_uniform(random, 1, 12);
  return room;
}

OccluderLook random_front(Random& random, int level) {
  OccluderLook front;
  if (level < 2) return front;
  const Light colour = tinted(random, log_uniform(random, 0.02, 0.6), 0.2);
  if (chance(random, 0.2)) {
    const int count = 1 + static_cast<int>(random.below(2));
    const double angle = chance(random, 0.4) ? 0 : chance(random, 0.5) ? kPi / 2 : random.uniform(0, kPi);
    for (int k = 0; k < count; ++k) {
      Bar bar;
      bar.angle = angle + (count > 1 && chance(random, 0.5) ? k * kPi / 2 : 0);
      bar.offset = chance(random, 0.4) ? 0 : random.uniform(-0.7, 0.7);
      bar.width = random.uniform(0.04, 0.2);
      if (chance(random, 0.3)) bar.begin = random.uniform(-0.1, 0.1);
      bar.colour = colour;
      front.bars.push_back(bar);
    }
  }
  if (chance(random, front.bars.empty() ? 0.12 : 0.4)) front.hub = random.uniform(0.06, 0.28);
  front.hub_colour = chance(random, 0.5) ? colour : grey(log_uniform(random, 0.05, 0.7));
  return front;
}

}  // namespace

FilmLook random_look(std::uint64_t seed, int level) {
  Random random(seed * 0x2545F4914F6CDD1Dull + 7);
  for (int k = 0; k < 3; ++k) random.next();
  FilmLook look;
  look.seed = seed;
  look.lens = random_lens(random, level);
  look.timing = random_timing(random, level);
  look.sensor = random_sensor(random, level);
  look.lamps = random_lamps(random, level);
  const double ambient = random.uniform(0.1, 0.9);
  look.ambient_above = tinted(random, ambient, 0.08);
  look.ambient_below = tinted(random, ambient * random.uniform(0.15, 0.8), 0.1);
  // A third are what most mills are: steel in steel, in a grey hall.
  const bool steel = chance(random, 0.35);
  look.balls = random_balls(random, level, steel);
  look.liner = random_surface(random, level, 0.01, 0.6);
  look.flange = random_flange(random, level);
  look.plate = random_plate(random, level);
  look.glass = random_glass(random, level);
  look.room = random_room(random, level);
  look.front = random_front(random, level);
  if (steel) {
    for (Surface* face : {&look.liner, &look.flange.surface, &look.plate.surface}) {
      face->colour = tinted(random, log_uniform(random, 0.02, 0.5), 0.04);
      face->gloss = random.uniform(0.1, 0.6);
    }
    look.room.wall = tinted(random, log_uniform(random, 0.05, 0.6), 0.05);
    look.sensor.saturation *= 0.8;
  }
  if (level > 0 && chance(random, 0.2)) look.overlay.clock = true;
  if (level > 0 && chance(random, 0.2)) look.overlay.words = 1 + static_cast<int>(random.below(3));
  place_mill(look.lens, 1280, 720, 290, 639.5, 359.5, 0);
  return look;
}

FilmLook studio_look(std::uint64_t seed, int width, int height) {
  FilmLook look = random_look(seed, 0);
  Random random(seed * 71 + 19);
  random.next();
  BallMaterial steel;
  steel.colour = tinted(random, random.uniform(0.25, 0.5), 0.03);
  steel.dirt = 0.15;
  look.balls.materials = {steel};
  look.balls.mark = BallMark::kLine;
  look.balls.marked_share = chance(random, 0.5) ? 1 : 0.1;
  look.balls.mark_colour = grey(0.9);
  look.balls.paints.clear();
  look.balls.tracers = {paint_of(0.0, 0.7), paint_of(0.14, 0.8), paint_of(0.6, 0.7)};
  look.balls.hollow_share = 0;
  look.plate.surface.colour = tinted(random, random.uniform(0.08, 0.3), 0.03);
  look.plate.surface.brushed = random.uniform(0.3, 0.7);
  look.liner.colour = tinted(random, random.uniform(0.03, 0.15), 0.04);
  look.flange.there = true;
  look.flange.letters = 0;
  look.flange.surface.colour = tinted(random, random.uniform(0.15, 0.4), 0.04);
  look.room.wall = tinted(random, random.uniform(0.12, 0.5), 0.04);
  look.room.rectangles = look.room.cables = look.room.discs = look.room.heaps = 0;
  look.room.wheels = look.room.display = false;
  look.room.stand_colour = tinted(random, 0.05, 0.3);
  look.timing.exposure = 0.001;
  look.sensor.level = 0.65;
  look.sensor.saturation = 1;
  place_mill(look.lens, width, height, 0.46 * std::min(width, height) / look.flange.outer, (width - 1) / 2.0,
             (height - 1) / 2.0, 0);
  return look;
}

}  // namespace tumble::render
