#include "render/discs.h"

namespace tumble::render {
namespace {

constexpr const char* kVertex = R"(
layout(location = 0) in vec3 circle;     // centre, radius
layout(location = 1) in vec4 look;       // mark direction, mark strength, gloss
layout(location = 2) in vec4 colour;
out vec2 offset;                         // from the centre [px]
flat out float radius;
flat out vec4 disc_look;
flat out vec4 disc_colour;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  offset = corner * (circle.z + 0.5);  // as far as anything is covered
  radius = circle.z;
  disc_look = look;
  disc_colour = colour;
  gl_Position = clip_from_image(circle.xy + offset);
})";

// One light from the upper left, close to the camera, and a dim sky: enough for a sphere, cheap on a CPU (no pow).
constexpr const char* kFragment = R"(
in vec2 offset;
flat in float radius;
flat in vec4 disc_look;
flat in vec4 disc_colour;
out vec4 pixel;
const vec3 light = vec3(-0.42, 0.58, 0.698);
void main() {
  float d = length(offset);
  float cover = clamp(radius - d + 0.5, 0.0, 1.0);
  vec2 q = offset / radius;
  float z = sqrt(max(1.0 - dot(q, q), 0.0));
  vec3 n = vec3(q.x, -q.y, z);
  float lit = max(dot(n, light), 0.0);

  // The painted mark: a stripe across the ball that ends in a dot on one side, so half turns can be told apart.
  vec2 m = disc_look.xy;
  float along = dot(q, m), across = abs(dot(q, vec2(-m.y, m.x)));
  float soft = 1.0 / radius;
  float inside = max(min(0.075 - across, 0.80 - abs(along)), 0.18 - length(q - 0.50 * m));  // > 0 on the mark
  float mark = clamp(inside / soft + 0.5, 0.0, 1.0) * disc_look.z;
  float halo = clamp((inside + 0.05) / soft + 0.5, 0.0, 1.0) * disc_look.z;  // lets it read on pale balls too

  // Steel mirrors its surroundings: a bright sky above, a dark floor below with a darker line where they meet, a
  // sharper light, and at grazing angles more of it all.
  float gloss = disc_look.w;
  float h = max(2.0 * z * dot(n, light) - light.z, 0.0);  // light direction . reflected view
  float spark = h * h; spark *= spark; spark *= spark; spark *= spark;
  float up = 2.0 * n.y * z;  // of the mirrored direction
  float grazing = 1.0 - z; grazing *= grazing;
  float seen = 0.98 + 0.36 * up - 0.34 / (1.0 + 14.0 * up * up) + (0.55 + 0.45 * up) * grazing;
  vec3 base = disc_colour.rgb;
  vec3 body = base * (0.30 + 0.78 * lit) * mix(1.0, seen, gloss);
  body = mix(body, base * 0.25, 0.75 * halo);
  body = mix(body, vec3(0.97) * (0.40 + 0.65 * lit), mark);
  body += vec3(1.0, 0.98, 0.94) * spark * mix(0.22, 0.60, gloss);

  // A dark limb, inside the radius, parts balls that touch; balls of a few pixels would be nothing but limb.
  float limb = clamp(0.085 * radius, 0.5, 0.6 + 0.035 * radius);
  float rim = clamp((d - (radius - limb)) + 0.5, 0.0, 1.0);
  body = mix(body, base * 0.10, rim * clamp(0.25 * radius, 0.0, 1.0));
  pixel = vec4(clamp(body, 0.0, 1.0), 1.0) * (cover * disc_colour.a);
})";

}  // namespace

Discs::Discs(int width, int height) : pipeline_(make_pipeline(kVertex, kFragment, width, height)) {
  constexpr int stride = sizeof(Instance);
  set_attribute(pipeline_, 0, 3, GL_FLOAT, false, stride, offsetof(Instance, x), 1);
  set_attribute(pipeline_, 1, 4, GL_FLOAT, false, stride, offsetof(Instance, mark_x), 1);
  set_attribute(pipeline_, 2, 4, GL_UNSIGNED_BYTE, true, stride, offsetof(Instance, colour), 1);
}

void Discs::add(const Disc& disc) {
  if (recorder_.is_on())
    return recorder_.add(Drawing::Ball{disc.centre, disc.radius, disc.colour, disc.mark, disc.mark_strength});
  const auto f = [](double value) { return static_cast<float>(value); };
  instances_.push_back({f(disc.centre.x()), f(disc.centre.y()), f(disc.radius), f(disc.mark.x()), f(disc.mark.y()),
                        f(disc.mark_strength), f(disc.gloss), disc.colour});
}

void Discs::flush() {
  if (recorder_.is_on()) return recorder_.flush();
  if (instances_.empty()) return;
  glUseProgram(pipeline_.program);
  glBindVertexArray(pipeline_.vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, pipeline_.buffer);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(instances_.size() * sizeof(Instance)), instances_.data(),
               GL_STREAM_DRAW);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(instances_.size()));
  instances_.clear();
}

}  // namespace tumble::render
