#include "render/meshes.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::render {
namespace {

constexpr const char* kVertex = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 colour;
out vec4 vertex_colour;
void main() {
  vertex_colour = colour;
  gl_Position = clip_from_image(position);
})";

constexpr const char* kFragment = R"(
in vec4 vertex_colour;
out vec4 pixel;
void main() { pixel = vertex_colour; })";

constexpr double kFeather = 0.5;  // half of the pixel over which an edge fades

Vec2 left_of(const Vec2& direction) { return {-direction.y(), direction.x()}; }

double signed_area(std::span<const Vec2> corners) {
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &p = corners[i], &q = corners[(i + 1) % corners.size()];
    area += p.x() * q.y() - q.x() * p.y();
  }
  return area / 2;
}

// The bisector of two edge normals, long enough that both edges move by 1; limited at sharp corners.
Vec2 mitre(const Vec2& n0, const Vec2& n1) {
  const Vec2 sum = n0 + n1;
  return sum * std::min(2.0 / std::max(sum.squaredNorm(), 1e-9), 2.0);
}

}  // namespace

Meshes::Meshes(int width, int height) : pipeline_(make_pipeline(kVertex, kFragment, width, height)) {
  set_attribute(pipeline_, 0, 2, GL_FLOAT, false, sizeof(Vertex), offsetof(Vertex, x));
  set_attribute(pipeline_, 1, 4, GL_UNSIGNED_BYTE, true, sizeof(Vertex), offsetof(Vertex, colour));
}

void Meshes::vertex(const Vec2& p, Rgba colour) {
  const Rgba premultiplied = colour.a == 255 ? colour : scaled(colour, colour.a / 255.0);
  vertices_.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), premultiplied});
}

// A drawing's shapes are of one colour.
void Meshes::record_polygon(std::span<const Vec2> corners, std::span<const Rgba> colours, bool has_neighbours) {
  double r = 0, g = 0, b = 0, a = 0;
  for (const Rgba& c : colours) {
    r += c.r;
    g += c.g;
    b += c.b;
    a += c.a;
  }
  const auto mean = [n = static_cast<double>(colours.size())](double sum) {
    return static_cast<std::uint8_t>(std::lround(sum / n));
  };
  recorder_.add(
      Drawing::Polygon{{corners.begin(), corners.end()}, {mean(r), mean(g), mean(b), mean(a)}, has_neighbours});
}

void Meshes::triangle(const Vec2& a, const Vec2& b, const Vec2& c, Rgba at_a, Rgba at_b, Rgba at_c) {
  if (recorder_.is_on()) return record_polygon({{a, b, c}}, {{at_a, at_b, at_c}}, true);
  vertex(a, at_a);
  vertex(b, at_b);
  vertex(c, at_c);
}

void Meshes::quad(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d, Rgba at_a, Rgba at_b, Rgba at_c,
                  Rgba at_d) {
  triangle(a, b, c, at_a, at_b, at_c);
  triangle(a, c, d, at_a, at_c, at_d);
}

void Meshes::rectangle(double left, double top, double right, double bottom, Rgba colour) {
  if (recorder_.is_on())
    return record_polygon({{{left, top}, {right, top}, {right, bottom}, {left, bottom}}}, {{colour}}, true);
  quad({left, top}, {right, top}, {right, bottom}, {left, bottom}, colour, colour, colour, colour);
}

void Meshes::convex(std::span<const Vec2> corners, std::span<const Rgba> colours) {
  if (recorder_.is_on()) return record_polygon(corners, colours, false);
  const std::size_t n = corners.size();
  const double sense = signed_area(corners) > 0 ? -1.0 : 1.0;  // outward is to this side of an edge
  const auto normal = [&](std::size_t i) -> Vec2 {
    return sense * left_of((corners[(i + 1) % n] - corners[i]).normalized());
  };
  std::vector<Vec2> in(n), out(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 m = kFeather * mitre(normal((i + n - 1) % n), normal(i));
    in[i] = corners[i] - m;
    out[i] = corners[i] + m;
  }
  for (std::size_t i = 2; i < n; ++i) triangle(in[0], in[i - 1], in[i], colours[0], colours[i - 1], colours[i]);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    quad(in[i], in[j], out[j], out[i], colours[i], colours[j], with_alpha(colours[j], 0), with_alpha(colours[i], 0));
  }
}

void Meshes::convex(std::span<const Vec2> corners, Rgba colour) {
  const std::vector<Rgba> colours(corners.size(), colour);
  convex(corners, colours);
}

void Meshes::line(const Vec2& a, const Vec2& b, double width, Rgba at_a, Rgba at_b) {
  if ((b - a).squaredNorm() < 1e-12) return;
  if (recorder_.is_on()) return recorder_.add(Drawing::Stroke{{a, b}, width, mix(at_a, at_b, 0.5)});
  const Vec2 side = left_of((b - a).normalized());
  const double solid = std::max(width / 2 - kFeather, 0.0), reach = std::max(width / 2, kFeather) + kFeather;
  const double strength = std::min(width, 1.0);  // a line thinner than a pixel is a paler one
  const Rgba ca = with_alpha(at_a, strength), cb = with_alpha(at_b, strength);
  const Rgba za = with_alpha(at_a, 0), zb = with_alpha(at_b, 0);
  quad(a - reach * side, b - reach * side, b - solid * side, a - solid * side, za, zb, cb, ca);
  if (solid > 0) quad(a - solid * side, b - solid * side, b + solid * side, a + solid * side, ca, cb, cb, ca);
  quad(a + solid * side, b + solid * side, b + reach * side, a + reach * side, ca, cb, zb, za);
}

void Meshes::polyline(std::span<const Vec2> points, double width, Rgba colour) {
  if (points.size() < 2) return;
  if (recorder_.is_on()) return recorder_.add(Drawing::Stroke{{points.begin(), points.end()}, width, colour});
  const double solid = std::max(width / 2 - kFeather, 0.0), reach = std::max(width / 2, kFeather) + kFeather;
  const Rgba full = with_alpha(colour, std::min(width, 1.0)), none = with_alpha(colour, 0);
  const auto side_of = [&](std::size_t i) -> Vec2 {
    const Vec2 d = points[i + 1] - points[i];
    return d.squaredNorm() > 1e-12 ? Vec2(left_of(d.normalized())) : Vec2(0, 1);
  };
  Vec2 before = side_of(0);
  Vec2 at = before;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec2 here = side_of(i);
    const Vec2 after = i + 2 < points.size() ? side_of(i + 1) : here;
    const Vec2 next = here.dot(after) > -0.3 ? mitre(here, after) : here;  // hairpins stay blunt
    const Vec2 &a = points[i], &b = points[i + 1];
    quad(a - reach * at, b - reach * next, b - solid * next, a - solid * at, none, none, full, full);
    if (solid > 0) quad(a - solid * at, b - solid * next, b + solid * next, a + solid * at, full, full, full, full);
    quad(a + solid * at, b + solid * next, b + reach * next, a + reach * at, full, full, none, none);
    at = here.dot(after) > -0.3 ? next : after;
  }
}

void Meshes::ring(const Vec2& centre, double inner, double outer, double from, double to,
                  const std::function<Rgba(double)>& colour_inner, const std::function<Rgba(double)>& colour_outer) {
  if (recorder_.is_on()) {
    const double middle = (from + to) / 2;
    return recorder_.add(
        Drawing::Ring{centre, inner, outer, from, to, mix(colour_inner(middle), colour_outer(middle), 0.5)});
  }
  if (const double width = outer - inner;
      inner > 0 && width < 2 * kFeather - 1e-6) {  // thinner than a pixel: a paler one
    const double middle = (inner + outer) / 2;
    const auto paler = [width](const std::function<Rgba(double)>& colour) {
      return [width, &colour](double angle) { return with_alpha(colour(angle), width); };
    };
    const auto pale_inner = paler(colour_inner), pale_outer = paler(colour_outer);
    return ring(centre, middle - kFeather, middle + kFeather, from, to, pale_inner, pale_outer);
  }
  // Chords whose sagitta stays below a twentieth of a pixel.
  const double step = 2 * std::acos(1 - std::min(0.05 / std::max(outer, 1.0), 0.5));
  const int n = std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / step)));
  const auto at = [&](int i) { return from + (to - from) * i / n; };
  const auto point = [&](double angle, double radius) -> Vec2 {
    return centre + radius * Vec2(std::cos(angle), -std::sin(angle));
  };
  const double in = inner > 0 ? inner + kFeather : 0.0;
  for (int i = 0; i < n; ++i) {
    const double p = at(i), q = at(i + 1);
    const Rgba ip = colour_inner(p), iq = colour_inner(q), op = colour_outer(p), oq = colour_outer(q);
    if (inner > 0) {
      quad(point(p, inner - kFeather), point(q, inner - kFeather), point(q, in), point(p, in), with_alpha(ip, 0),
           with_alpha(iq, 0), iq, ip);
    }
    quad(point(p, in), point(q, in), point(q, outer - kFeather), point(p, outer - kFeather), ip, iq, oq, op);
    quad(point(p, outer - kFeather), point(q, outer - kFeather), point(q, outer + kFeather), point(p, outer + kFeather),
         op, oq, with_alpha(oq, 0), with_alpha(op, 0));
  }
}

void Meshes::ring(const Vec2& centre, double inner, double outer, double from, double to, Rgba colour) {
  const auto same = [colour](double) { return colour; };
  ring(centre, inner, outer, from, to, same, same);
}

void Meshes::flush() {
  if (recorder_.is_on()) return recorder_.flush();
  if (vertices_.empty()) return;
  glUseProgram(pipeline_.program);
  glBindVertexArray(pipeline_.vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, pipeline_.buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(Vertex)), vertices_.data(),
               GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(vertices_.size()));
  vertices_.clear();
}

}  // namespace tumble::render
