#include "render/film_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/quantile.h"
#include "core/random.h"
#include "core/units.h"
#include "render/film_crowd.h"
#include "render/film_develop.h"
#include "render/film_dress.h"
#include "render/film_lens.h"
#include "render/film_parts.h"
#include "render/film_shaders.h"
#include "render/film_sheets.h"
#include "render/film_textures.h"
#include "render/offscreen_context.h"
#include "render/outline_table.h"
#include "render/shader.h"

namespace tumble::render {
namespace {

float f(double value) { return static_cast<float>(value); }

std::string indexed(const char* name, int k) { return fmt::format("{}[{}]", name, k); }

struct BallInstance {
  float box[4], ball[4], motion[4], turn[4], colour[4], crowd[4], chance[4];
};
struct ShadowInstance {
  float box[4], shadow[4], motion[4];
};

// Where in the pixel each sub-exposure looks: a sequence of low discrepancy (Roberts 2018). Its mean is taken out, for
// that would move the whole picture.
std::vector<Eigen::Vector2d> jitters_of(int count, double first) {
  std::vector<Eigen::Vector2d> jitters;
  Eigen::Vector2d mean(0, 0);
  for (int k = 1; k <= count; ++k) {
    jitters.emplace_back(std::fmod(first + 0.7548776662466927 * k, 1.0),
                         std::fmod(first + 0.5698402909980532 * k, 1.0));
    mean += jitters.back() / count;
  }
  for (Eigen::Vector2d& j : jitters) j -= mean;
  return jitters;
}

// Texture units.
enum Unit { kNoise, kOutline, kDecals, kRoom, kPicture, kGlass };

// The uniforms of one program, by name.
struct Uniforms {
  GLuint program;
  GLint at(const char* name) const { return glGetUniformLocation(program, name); }
  void set(const char* name, int v) const { glUniform1i(at(name), v); }
  void set(const char* name, double a) const { glUniform1f(at(name), f(a)); }
  void set(const char* name, double a, double b) const { glUniform2f(at(name), f(a), f(b)); }
  void set(const char* name, double a, double b, double c) const { glUniform3f(at(name), f(a), f(b), f(c)); }
  void set(const char* name, double a, double b, double c, double d) const {
    glUniform4f(at(name), f(a), f(b), f(c), f(d));
  }
  void set(const char* name, const Light& c) const { glUniform3f(at(name), c[0], c[1], c[2]); }
  void set(const char* name, int k, double a, double b, double c, double d) const {
    set(indexed(name, k).c_str(), a, b, c, d);
  }
};

double exponent_of(double roughness) { return std::clamp(2 / std::pow(roughness, 3) - 1, 1.0, 2000.0); }

}  // namespace

struct FilmCamera::Impl {
  Impl();
  void make_buffers();
  void shake_by(const Eigen::Vector2d& by);
  void set_common(const Pipeline& pipeline) const;
  void set_drum(const Pipeline& part) const;
  void set_balls() const;
  std::vector<SeenBall> see(const FilmMoment& moment) const;
  void place(const std::vector<SeenBall>& seen, double exposure);
  int sub_exposures(const std::vector<SeenBall>& seen, const FilmMoment& moment) const;
  void shoot(const FilmMoment& moment, int count, std::vector<float>& hits);
  MillPlace place_in_picture() const;

  OffscreenContext context{64, 64};
  Pipeline behind, flange, plate, wall, balls, shadows, glass, sum;
  GLuint noise = 0, outline = 0, decals = 0, room = 0, on_glass = 0;
  GLuint picture = 0, numbers = 0, depth = 0, summed = 0, shot_buffer = 0, sum_buffer = 0;
  int width = 0, height = 0;

  FilmLook look;
  FilmScene scene;
  Pinhole at_rest, pinhole;  // without and with the picture's shake
  Eigen::Vector2d shake{0, 0};
  std::vector<BallDress> dresses;
  StillSheets still_at_rest, still;
  OutlineTable table;
  DrumParts parts;
  float gain = 0;  // 0: to be found with the next picture
  bool has_glass = false;
  std::vector<BallInstance> ball_instances;
  std::vector<ShadowInstance> shadow_instances;
  std::vector<float> read_back;
};

FilmCamera::Impl::Impl() {
  const CurrentContext current(context);
  const auto program = [](const char* vertex, const char* fragment) {
    return make_pipeline(vertex, (std::string(film::kCommon) + fragment).c_str(), 64, 64);
  };
  const auto drum_part = [&](const char* fragment) {
    const Pipeline p = program(film::kPartVertex, (std::string(film::kDrumCommon) + fragment).c_str());
    set_attribute(p, 0, 2, GL_FLOAT, false, 2 * sizeof(float), 0);
    return p;
  };
  behind = program(film::kWholeVertex, film::kRoomFragment);
  flange = drum_part(film::kFlangeFragment);
  plate = drum_part(film::kPlateFragment);
  wall = drum_part(film::kWallFragment);
  balls = program(film::kBallVertex, film::kBallFragment);
  shadows = program(film::kShadowVertex, film::kShadowFragment);
  glass = program(film::kPartVertex, film::kGlassFragment);
  set_attribute(glass, 0, 2, GL_FLOAT, false, 2 * sizeof(float), 0);
  sum = program(film::kWholeVertex, film::kSumFragment);
  for (GLuint k = 0; k < 7; ++k)
    set_attribute(balls, k, 4, GL_FLOAT, false, sizeof(BallInstance), k * 4 * sizeof(float), 1);
  for (GLuint k = 0; k < 3; ++k)
    set_attribute(shadows, k, 4, GL_FLOAT, false, sizeof(ShadowInstance), k * 4 * sizeof(float), 1);
  noise = make_texture(GL_REPEAT);
  fill_with_noise(noise);
  outline = make_texture(GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  decals = make_texture(GL_CLAMP_TO_EDGE);
  on_glass = make_texture(GL_CLAMP_TO_EDGE);
  room = make_texture(GL_CLAMP_TO_EDGE);
  picture = make_texture(GL_CLAMP_TO_EDGE);
  numbers = make_texture(GL_CLAMP_TO_EDGE);
  summed = make_texture(GL_CLAMP_TO_EDGE);
  glGenRenderbuffers(1, &depth);
  glGenFramebuffers(1, &shot_buffer);
  glGenFramebuffers(1, &sum_buffer);
}

void FilmCamera::Impl::make_buffers() {
  if (width == look.lens.width && height == look.lens.height) return;
  width = look.lens.width;
  height = look.lens.height;
  fill_texture(picture, GL_RGBA32F, GL_RGBA, width, height, nullptr);
  fill_texture(numbers, GL_R32F, GL_RED, width, height, nullptr);
  fill_texture(summed, GL_RGBA32F, GL_RGBA, width, height, nullptr);
  glBindRenderbuffer(GL_RENDERBUFFER, depth);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, shot_buffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, picture, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, numbers, 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw WorkError("render", "OpenGL has no picture of floating-point numbers to draw on");
  glBindFramebuffer(GL_FRAMEBUFFER, sum_buffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, summed, 0);
}

void FilmCamera::Impl::shake_by(const Eigen::Vector2d& by) {
  if (by == shake) return;
  shake = by;
  pinhole.centre_u = at_rest.centre_u + by.x();
  pinhole.centre_v = at_rest.centre_v + by.y();
  still = {shifted(still_at_rest.front, by), shifted(still_at_rest.glare, by / 4)};
}

void FilmCamera::Impl::set_common(const Pipeline& pipeline) const {
  glUseProgram(pipeline.program);
  const Uniforms u{pipeline.program};
  u.set("image_size", width, height);
  u.set("shake", shake.x(), shake.y());
  u.set("pinhole", pinhole.focal, pinhole.centre_u, pinhole.centre_v);
  u.set("bending", pinhole.k1, pinhole.k2);
  const Eigen::Matrix3f turn = pinhole.camera_from_mill.transpose().cast<float>();
  glUniformMatrix3fv(u.at("mill_from_camera"), 1, GL_FALSE, turn.data());
  u.set("eye", pinhole.eye.x(), pinhole.eye.y(), pinhole.eye.z());
  for (int k = 0; k < 2; ++k) {
    const bool lit = k < static_cast<int>(look.lamps.size());
    const Lamp lamp = lit ? look.lamps[k] : Lamp{};
    u.set(indexed("lamp_towards", k).c_str(), lamp.towards.x(), lamp.towards.y(), lamp.towards.z());
    u.set(indexed("lamp_colour", k).c_str(), lit ? lamp.colour : Light(0, 0, 0));
  }
  u.set("lamp_count", std::min(2, static_cast<int>(look.lamps.size())));
  u.set("lamp_size", look.lamps.front().size, look.lamps.back().size);
  u.set("above", look.ambient_above);
  u.set("below", look.ambient_below);
  u.set("noise", static_cast<int>(kNoise));
  u.set("mirror", scene.clockwise ? -1.0 : 1.0);
}

void FilmCamera::Impl::set_drum(const Pipeline& part) const {
  set_common(part);
  const Uniforms u{part.program};
  const double deep = scene.length / scene.shape.radius;
  u.set("outline", static_cast<int>(kOutline));
  u.set("decals", static_cast<int>(kDecals));
  u.set("outline_span", table.begin, table.end, table.tip, table.columns > 0 ? 1.0 : 0.0);
  u.set("tip", table.tip);
  u.set("at_depth", (0.4 + deep) / (0.8 + deep));  // as kCommon's depth_of
  const FlangeLook& rim = look.flange;
  u.set("flange_size", rim.inner, rim.outer, rim.there ? rim.thick : 0.0, rim.there ? 1.0 : 0.0);
  const std::array<const Surface*, 3> faces = {&rim.surface, &look.plate.surface, &look.liner};
  for (int k = 0; k < 3; ++k) {
    const Surface& s = *faces[k];
    u.set(indexed("surface_colour", k).c_str(), s.colour);
    u.set("surface_finish", k, s.gloss, exponent_of(s.roughness), s.brushed, s.blotches);
    u.set("surface_rust", k, s.rust_colour[0], s.rust_colour[1], s.rust_colour[2], s.rust);
    u.set(indexed("surface_grain", k).c_str(), s.grain, 0.0);
  }
  Random random(look.seed * 61 + 13);
  u.set("seeds", random.uniform(), random.uniform(), random.uniform(), random.uniform());
}

void FilmCamera::Impl::set_balls() const {
  set_common(balls);
  const Uniforms u{balls.program};
  const BallLook& b = look.balls;
  for (int k = 0; k < 4; ++k) {
    const BallMaterial& m = b.materials[std::min<std::size_t>(k, b.materials.size() - 1)];
    u.set("material_shine", k, m.metal, m.specular, exponent_of(m.roughness), m.translucent);
    u.set("material_dirt", k, m.dirt, m.rust, 0, 0);
  }
  u.set("mark_look", b.mark_width, b.occlusion, b.depth_fade, b.hole);
  u.set("mark_colour", b.mark_colour);
  u.set("surroundings", Light(0.35f * look.plate.surface.colour + 0.25f * b.materials.front().colour));
}

MillPlace FilmCamera::Impl::place_in_picture() const {
  const Eigen::Vector2d centre = pinhole.image_from_mill(Eigen::Vector3d::Zero());
  return {centre, mill_circle_px(pinhole)};
}

// Each ball at the middle of its own row's exposure: where it is decides the row, so a few rounds.
std::vector<SeenBall> FilmCamera::Impl::see(const FilmMoment& moment) const {
  const double scale = 1 / scene.shape.radius;
  std::vector<SeenBall> seen(scene.radius.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    SeenBall& s = seen[i];
    s.ball = i;
    s.v = (height - 1) / 2.0;
    for (int round = 0; round < (look.timing.readout > 0 ? 3 : 1); ++round) {
      s.state = moment.ball(i, look.timing.readout * ((s.v + 0.5) / height - 0.5));
      if (scene.clockwise) {
        s.state.x = -s.state.x;
        s.state.vx = -s.state.vx;
        s.state.angle = kPi - s.state.angle;
        s.state.spin = -s.state.spin;
      }
      const Eigen::Vector2d at = pinhole.image_from_mill(Eigen::Vector3d(s.state.x, s.state.y, s.state.z) * scale);
      s.u = at.x();
      s.v = at.y();
    }
    s.radius_px =
        silhouette(pinhole, Eigen::Vector3d(s.state.x, s.state.y, s.state.z) * scale, scene.radius[i] * scale).radius;
    s.marked = dresses[i].marked;
    s.tracer = dresses[i].tracer;
  }
  return seen;
}

// Quads for balls and shadows.
void FilmCamera::Impl::place(const std::vector<SeenBall>& seen, double exposure) {
  const double scale = 1 / scene.shape.radius, deep = scene.length * scale;
  std::vector<PlacedBall> placed;
  for (const SeenBall& s : seen)
    placed.push_back({Eigen::Vector3d(s.state.x, s.state.y, s.state.z) * scale, scene.radius[s.ball] * scale});
  const std::vector<Crowding> crowding = crowding_of(placed, look.lamps);
  const Eigen::Vector3d lamp = look.lamps.front().towards;
  ball_instances.clear();
  shadow_instances.clear();
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const SeenBall& s = seen[i];
    const PlacedBall& p = placed[i];
    const BallDress& d = dresses[i];
    const Silhouette outer = silhouette(pinhole, p.centre, p.radius);
    const double vx = s.state.vx * scale, vy = s.state.vy * scale;
    // How far it may stray from its place: during the exposure, and from its first row to its last.
    const double seconds = 0.5 * exposure + look.timing.readout * (outer.half_height + 4) / height;
    const double stray = std::hypot(vx, vy) * seconds * outer.radius / p.radius * 1.2 + 1.5;
    const double half_width = outer.half_width + stray, half_height = outer.half_height + stray;
    const bool in_sight =
        s.u > -half_width && s.u < width + half_width && s.v > -half_height && s.v < height + half_height;
    if (!in_sight) continue;
    const Crowding& c = crowding[i];
    ball_instances.push_back({{f(s.u), f(s.v), f(half_width), f(half_height)},
                              {f(p.centre.x()), f(p.centre.y()), f(p.centre.z()), f(p.radius)},
                              {f(vx), f(vy), f(s.v), f(double(i) + 1)},
                              {f(std::remainder(s.state.angle, 2 * kPi)), f(s.state.spin), d.brightness, d.material},
                              {d.colour[0], d.colour[1], d.colour[2], d.kind},
                              {c.towards[0], c.towards[1], c.towards[2], d.tilt},
                              {d.chance_x, d.chance_y, c.reach[0], c.reach[1]}});
    // A shadow on the back plate is deepest where the ball lies at it; far in front of it nothing is left.
    const double above_plate = p.centre.z() + deep;
    if (above_plate > 3.5 * p.radius) continue;
    const Eigen::Vector3d at = p.centre - lamp * (above_plate / std::max(lamp.z(), 0.3));
    const double soft = std::min(p.radius * 0.25 + above_plate * (0.2 + look.lamps.front().size), 1.2 * p.radius);
    const Eigen::Vector3d on_plate(at.x(), at.y(), -deep);
    const Eigen::Vector2d where = pinhole.image_from_mill(on_plate);
    const double reach = (p.radius + soft) * outer.radius / p.radius + stray;
    shadow_instances.push_back({{f(where.x()), f(where.y()), f(reach), f(reach)},
                                {f(on_plate.x()), f(on_plate.y()), f(p.radius), f(soft)},
                                {f(vx), f(vy), f(s.v), f(0.75 * p.radius / std::max(above_plate, p.radius))}});
  }
  const auto upload = [](const Pipeline& pipeline, const auto& instances) {
    glBindBuffer(GL_ARRAY_BUFFER, pipeline.buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances.size() * sizeof(instances[0])), instances.data(),
                 GL_STREAM_DRAW);
  };
  upload(balls, ball_instances);
  upload(shadows, shadow_instances);
}

// Enough for smooth streaks: one for each pixel and a half of the fastest motion, at least four for clean edges.
int FilmCamera::Impl::sub_exposures(const std::vector<SeenBall>& seen, const FilmMoment& moment) const {
  std::vector<double> streaks{0};
  for (const SeenBall& s : seen)
    streaks.push_back(std::hypot(s.state.vx, s.state.vy) / scene.radius[s.ball] * s.radius_px * look.timing.exposure);
  const double fast = quantile_of(std::move(streaks), 0.97);
  const double rim = std::abs(moment.mill_speed) * look.timing.exposure * place_in_picture().radius;
  return std::clamp(static_cast<int>(std::max(fast, 0.5 * rim) / 1.5) + 1, 4, 20);
}

void FilmCamera::Impl::shoot(const FilmMoment& moment, int count, std::vector<float>& hits) {
  const auto bind = [](Unit unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
  };
  bind(kOutline, outline);
  bind(kDecals, decals);
  bind(kRoom, room);
  bind(kPicture, picture);
  bind(kGlass, on_glass);
  bind(kNoise, noise);
  glViewport(0, 0, width, height);
  glDisable(GL_DITHER);
  glBindFramebuffer(GL_FRAMEBUFFER, sum_buffer);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  set_common(sum);
  const Uniforms last{sum.program};
  last.set("picture", static_cast<int>(kPicture));
  last.set("share", 1.0 / count);
  for (const Pipeline* pipeline : {&shadows, &behind, &glass}) set_common(*pipeline);
  set_balls();
  glUseProgram(glass.program);
  Uniforms{glass.program}.set("on_glass", static_cast<int>(kGlass));
  glUseProgram(behind.program);
  Uniforms{behind.program}.set("room", static_cast<int>(kRoom));
  for (const Pipeline* part : {&flange, &plate, &wall}) set_drum(*part);

  const double deep = scene.length / scene.shape.radius;
  const std::vector<Eigen::Vector2d> jitters = jitters_of(count, Random(look.seed + 77).uniform());
  read_back.resize(static_cast<std::size_t>(width) * height);
  for (int k = 0; k < count; ++k) {
    const double when = look.timing.exposure * ((k + 0.5) / count - 0.5);
    const auto begin = [&](const Pipeline& pipeline) {
      glUseProgram(pipeline.program);
      glBindVertexArray(pipeline.vertex_array);
      const Uniforms u{pipeline.program};
      u.set("jitter", jitters[k].x(), jitters[k].y());
      u.set("clock", when, look.timing.readout, deep);
      return u;
    };
    const std::array<GLenum, 2> both = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glBindFramebuffer(GL_FRAMEBUFFER, shot_buffer);
    glDrawBuffers(2, both.data());
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    begin(behind);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);

    // The plate after the balls: it has a depth of its own, so that what they hide costs nothing.
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    begin(balls);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(ball_instances.size()));
    for (const auto& [part, corners] :
         {std::pair{&flange, parts.flange.size() / 2}, std::pair{&plate, parts.plate.size() / 2},
          std::pair{&wall, parts.wall.size() / 2}}) {
      begin(*part).set("turning", moment.mill_angle, moment.mill_speed);
      glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(corners));
    }
    glDepthMask(GL_FALSE);
    glEnablei(GL_BLEND, 0);
    glBlendFunc(GL_ZERO, GL_ONE_MINUS_SRC_ALPHA);
    begin(shadows);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(shadow_instances.size()));
    if (has_glass) {
      glDisable(GL_DEPTH_TEST);
      glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
      glBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
      begin(glass).set("turning", moment.mill_angle, moment.mill_speed);
      glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>((parts.plate.size() + parts.wall.size()) / 2));
      glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    }
    glDisablei(GL_BLEND, 0);
    glDepthMask(GL_TRUE);

    glReadBuffer(GL_COLOR_ATTACHMENT1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RED, GL_FLOAT, read_back.data());
    for (int j = 0; j < height; ++j) {
      const float* line = read_back.data() + static_cast<std::size_t>(height - 1 - j) * width;
      for (int i = 0; i < width; ++i)
        if (line[i] > 0) hits[static_cast<std::size_t>(line[i]) - 1] += 1 - still.front.at(i, j)[3];
    }

    glBindFramebuffer(GL_FRAMEBUFFER, sum_buffer);
    glDisable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    begin(sum);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    glDisable(GL_BLEND);
  }
}

CameraNumbers camera_numbers(const FilmLens& lens) {
  const Pinhole pinhole = make_pinhole(lens);
  return {pinhole.camera_from_mill, pinhole.image_from_mill(Eigen::Vector3d::Zero()), mill_circle_px(pinhole)};
}

FilmCamera::FilmCamera() : impl_(std::make_unique<Impl>()) {}
FilmCamera::~FilmCamera() = default;

void FilmCamera::aim(const FilmLook& look, const FilmScene& scene) {
  Impl& my = *impl_;
  const CurrentContext current(my.context);
  my.look = look;
  my.scene = scene;
  my.pinhole = my.at_rest = make_pinhole(look.lens);
  my.shake = Eigen::Vector2d::Zero();
  my.dresses = dress(look.balls, scene.ball_class, look.seed);
  my.gain = 0;
  my.make_buffers();
  my.table = make_outline_table(scene.shape);
  if (my.table.columns > 0)
    fill_texture(my.outline, GL_R32F, GL_RED, my.table.columns, my.table.rows, my.table.distance.data());
  my.parts = drum_parts(my.pinhole, look.flange, my.table.tip, scene.length / scene.shape.radius);
  const auto upload = [](const Pipeline& part, const std::vector<float>& corners) {
    glBindBuffer(GL_ARRAY_BUFFER, part.buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof(float)), corners.data(),
                 GL_STATIC_DRAW);
  };
  upload(my.flange, my.parts.flange);
  upload(my.plate, my.parts.plate);
  upload(my.wall, my.parts.wall);
  std::vector<float> whole = my.parts.plate;
  whole.insert(whole.end(), my.parts.wall.begin(), my.parts.wall.end());
  upload(my.glass, whole);
  const MillPlace place = my.place_in_picture();
  double mean_radius = 0;
  for (const double r : scene.radius) mean_radius += r / (scene.shape.radius * double(scene.radius.size()));
  const Sheet painted = paint_decals(look, mean_radius);
  fill_texture(my.decals, GL_RGBA16F, GL_RGBA, kDecalSize, kDecalSize, painted.rgba.data());
  my.has_glass = look.glass.scratches > 0 || look.glass.smudges > 0;
  if (my.has_glass) {
    const Sheet glass = paint_glass(look);
    fill_texture(my.on_glass, GL_RGBA16F, GL_RGBA, kDecalSize, kDecalSize, glass.rgba.data());
  }
  const Sheet walls = paint_room(look, place, mean_radius);
  // OpenGL's first row is the lowest.
  std::vector<float> turned(walls.rgba.size());
  for (int j = 0; j < walls.height; ++j)
    std::copy(walls.at(0, j), walls.at(0, j) + 4 * walls.width,
              turned.begin() + 4 * static_cast<std::ptrdiff_t>(walls.height - 1 - j) * walls.width);
  fill_texture(my.room, GL_RGBA16F, GL_RGBA, walls.width, walls.height, turned.data());
  my.still_at_rest = my.still = {paint_front(look, place), paint_glare(look, place)};
}

FilmPicture FilmCamera::draw(const FilmMoment& moment, std::uint64_t picture) {
  Impl& my = *impl_;
  const CurrentContext current(my.context);
  FilmPicture film;
  my.shake_by(moment.shake);
  film.balls = my.see(moment);
  my.place(film.balls, my.look.timing.exposure);
  const int count = my.sub_exposures(film.balls, moment);
  std::vector<float> hits(film.balls.size());
  my.shoot(moment, count, hits);
  for (SeenBall& s : film.balls)
    s.visible = std::clamp(hits[s.ball] / (count * kPi * s.radius_px * s.radius_px), 0.0, 1.0);

  Sheet light(my.width, my.height);
  glBindFramebuffer(GL_FRAMEBUFFER, my.sum_buffer);
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  std::vector<float> rows(light.rgba.size());
  glReadPixels(0, 0, my.width, my.height, GL_RGBA, GL_FLOAT, rows.data());
  film.coverage.resize(static_cast<std::size_t>(my.width) * my.height);
  for (int j = 0; j < my.height; ++j) {
    std::copy_n(rows.begin() + 4 * static_cast<std::ptrdiff_t>(my.height - 1 - j) * my.width, 4 * my.width,
                light.at(0, j));
    for (int i = 0; i < my.width; ++i) {
      const float seen = light.at(i, j)[3] * (1 - my.still.front.at(i, j)[3]);
      film.coverage[static_cast<std::size_t>(j) * my.width + i] =
          static_cast<std::uint8_t>(255 * std::clamp(seen, 0.f, 1.f) + 0.5f);
    }
  }
  if (my.gain == 0) {
    const MillPlace place = my.place_in_picture();
    my.gain = exposure_gain(light, my.look, place.centre, place.radius);
  }
  for (SeenBall& s : film.balls) s.glare = my.gain * glare_at(my.still, s.u, s.v);
  film.image = develop(std::move(light), my.look, my.still, my.gain, moment.time, my.look.seed * 1000003 + picture);
  return film;
}

}  // namespace tumble::render
