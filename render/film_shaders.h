#pragma once

// The programs of film_camera.cpp. All lengths in shell radii; time relative to the middle of the exposure of the
// picture's middle row. Colour attachment 0 is linear light with the balls' coverage in alpha, 1 the ball's number + 1.
namespace tumble::render::film {

inline constexpr const char* kWholeVertex = R"(
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  gl_Position = vec4(corner, 0.0, 1.0);
})";

// What all fragments share: the pixel's ray, the row's time, noise, and lamps.
inline constexpr const char* kCommon = R"(
uniform vec2 image_size;
uniform vec3 pinhole;          // focal length, principal point [px]
uniform vec2 bending;          // k1, k2
uniform mat3 mill_from_camera;
uniform vec3 eye;
uniform vec2 jitter;           // of this sub-exposure [px]
uniform vec3 clock;            // of this sub-exposure [s]; readout [s]; depth of the mill
uniform vec3 lamp_towards[2];
uniform vec3 lamp_colour[2];
uniform vec2 lamp_size;
uniform int lamp_count;
uniform vec3 above, below;     // ambient light
uniform sampler2D noise;

vec2 pixel_here() { return vec2(gl_FragCoord.x - 0.5, image_size.y - 0.5 - gl_FragCoord.y); }
float row_time(float v) { return clock.x + clock.y * ((v + 0.5) / image_size.y - 0.5); }

vec3 ray_of(vec2 pixel) {
  vec2 d = (pixel + jitter - pinhole.yz) / pinhole.x;
  // Newton's way to the undistorted radius; film_lens.cpp has the same.
  float bent = length(d), r = bent;
  for (int i = 0; i < 4; ++i) {
    float r2 = r * r;
    r -= (r * (1.0 + r2 * (bending.x + bending.y * r2)) - bent) / (1.0 + r2 * (3.0 * bending.x + 5.0 * bending.y * r2));
  }
  vec2 q = d * (r / max(bent, 1e-9));
  return mill_from_camera * vec3(q, 1.0);
}

// Heights z of the mill to depth: linear from a little before the flange to behind the back plate.
float depth_of(float z) { return (0.4 - z) / (0.8 + clock.z); }
)";

// The room behind, which stands still.
inline constexpr const char* kRoomFragment = R"(
uniform sampler2D room;
uniform vec2 shake;   // [px]
layout(location = 0) out vec4 light;
layout(location = 1) out float number;
void main() {
  number = 0.0;
  vec2 moved = jitter - shake;
  light = vec4(texture(room, (gl_FragCoord.xy + vec2(moved.x, -moved.y)) / image_size).rgb, 0.0);
})";

// Rings and discs of the picture where a part of the drum may be seen; their fragments decide.
inline constexpr const char* kPartVertex = R"(
layout(location = 0) in vec2 place;   // [px]
uniform float at_depth;
uniform vec2 shake;                   // [px]
void main() {
  gl_Position = clip_from_image(place + shake);
  gl_Position.z = at_depth * 2.0 - 1.0;
})";

// What the parts of the drum share: turning, dirt, light. llvmpipe runs both sides of every branch, so each part has a
// program of its own.
inline constexpr const char* kDrumCommon = R"(
uniform vec2 turning;          // mill angle in the middle [rad], speed [rad/s], as simulated
uniform float mirror;          // -1: the mill turns clockwise
uniform sampler2D decals;      // over the mill's own frame from -1.5 to 1.5
uniform vec4 flange_size;      // inner, outer radius, thickness; 1 = there is one
uniform vec3 surface_colour[3];
uniform vec4 surface_finish[3];   // gloss, exponent, brushed, blotches
uniform vec4 surface_rust[3];     // colour, share
uniform vec2 surface_grain[3];
uniform vec4 seeds;
layout(location = 0) out vec4 light;
layout(location = 1) out float number;

// Into the mill's own frame: first as simulated, then turned back.
mat2 own_from_mill(float row) {
  float angle = turning.x + turning.y * row_time(row), c = cos(angle), s = sin(angle);
  return mat2(c * mirror, -s * mirror, s, c);
}

// A face's own colour where it is dirty, scratched and rusty; q in the mill's own frame.
vec3 face_colour(int kind, vec2 q, float streak) {
  vec4 finish = surface_finish[kind];
  vec4 coarse = texture(noise, q * 0.21 + seeds.xy + float(kind) * 0.37);
  vec4 fine = texture(noise, q * 1.9 + seeds.zw);
  float scratch = texture(noise, vec2(streak * 2.7 + coarse.g * 0.02, seeds.x)).b - 0.5;
  vec3 c = surface_colour[kind];
  c *= 1.0 + finish.z * 1.6 * scratch * (0.4 + coarse.b) + finish.w * 2.0 * (coarse.r - 0.5) +
       surface_grain[kind].x * 2.0 * (fine.b - 0.5);
  float share = surface_rust[kind].w;
  float spread = coarse.g * 0.75 + fine.g * 0.25;
  float rusty = smoothstep(0.0, 0.12, spread - (0.86 - 0.62 * share)) * step(0.001, share);
  return mix(max(c, 0.0), surface_rust[kind].rgb * (0.6 + 0.8 * fine.r), rusty * 0.85);
}

// Light on a face with this normal; `along` is the direction of its scratches, lit across.
vec3 lit(int kind, vec3 base, vec3 n, vec3 along, vec3 d, vec2 shade) {
  vec4 finish = surface_finish[kind];
  vec3 c = base * mix(below, above, 0.5 + 0.5 * n.y);
  for (int i = 0; i < lamp_count; ++i) {
    vec3 l = lamp_towards[i];
    float s = shade[i];
    vec3 h = normalize(l - d);
    float hn = dot(h, n), ha = dot(h, along), across = 1.0 - ha * ha;
    float glint = pow(max(mix(hn * hn, across * across, 0.75 * finish.z), 0.0), finish.y);
    c += lamp_colour[i] * s * (base * max(dot(n, l), 0.0) + finish.x * glint * (0.35 + 0.65 * base));
  }
  return c;
}

// How much of the lamps the rim in front leaves a point: soft shadows by the lamps' sizes.
vec2 rim_shade(vec3 where) {
  vec2 shade = vec2(1.0);
  float bore = flange_size.w > 0.5 ? flange_size.x : 1.02;
  for (int i = 0; i < lamp_count; ++i) {
    vec3 l = lamp_towards[i];
    float rise = flange_size.z - where.z;
    vec2 top = where.xy + l.xy / max(l.z, 0.05) * rise;
    shade[i] = smoothstep(-1.0, 1.0, (bore - length(top)) / (0.02 + lamp_size[i] * (rise + 0.05)));
  }
  return shade;
}

// The back plate at a point, `reach` from the shell's outline.
vec3 plate_light(vec2 where, vec2 q, float reach, vec3 unit) {
  float depth = clock.z, rho = length(where);
  vec4 decal = texture(decals, q / 3.0 + 0.5);
  vec3 base = face_colour(1, q, rho) * (1.0 - decal.a) + decal.rgb;
  vec3 along = vec3(-where.y, where.x, 0.0) / max(rho, 1e-3);
  float nook = mix(0.35, 1.0, smoothstep(-0.02, 0.5 * depth + 0.05, reach));
  return lit(1, base, vec3(0.0, 0.0, 1.0), along, unit, rim_shade(vec3(where, -depth))) * nook;
}
)";

inline constexpr const char* kFlangeFragment = R"(
void main() {
  vec2 pixel = pixel_here();
  vec3 d = ray_of(pixel);
  vec3 unit = normalize(d);
  vec2 slope = d.xy / max(-d.z, 1e-3);
  float face = flange_size.z;
  vec2 at = eye.xy + slope * (eye.z - face), inside = eye.xy + slope * eye.z;
  float rho = length(at);
  bool bore = rho <= flange_size.x;
  if (rho > flange_size.y || (bore && length(inside) <= flange_size.x)) discard;
  number = 0.0;
  if (bore) at = inside;
  vec2 q = own_from_mill(pixel.y) * at;
  vec4 decal = bore ? vec4(0.0) : texture(decals, q / 3.0 + 0.5);
  vec3 base = face_colour(0, q, rho) * (1.0 - decal.a) + decal.rgb;
  float edge = min(rho - flange_size.x, flange_size.y - rho);
  base *= bore ? 0.6 : 0.72 + 0.28 * smoothstep(0.0, 0.012, edge);
  vec3 n = bore ? vec3(-at / max(rho, 1e-3), 0.0) : vec3(0.0, 0.0, 1.0);
  light = vec4(lit(0, base, n, vec3(-at.y, at.x, 0.0) / max(rho, 1e-3), unit, vec2(bore ? 0.7 : 1.0)), 0.0);
  gl_FragDepth = depth_of(bore ? 0.5 * face : face);
})";

// The middle of the back plate, where no lifter comes between. Its depth is the quad's, so that what balls hide is
// never shaded.
inline constexpr const char* kPlateFragment = R"(
uniform float tip;
void main() {
  vec2 pixel = pixel_here();
  vec3 d = ray_of(pixel);
  vec2 at = eye.xy + d.xy / max(-d.z, 1e-3) * (eye.z + clock.z);
  number = 0.0;
  light = vec4(plate_light(at, own_from_mill(pixel.y) * at, tip - length(at), normalize(d)), 0.0);
})";

// Everything near the shell, ray-cast. The shell's inside is an extrusion, so a ray is followed in the plane, through
// the table of distances to its outline.
inline constexpr const char* kWallFragment = R"(
uniform sampler2D outline;     // distance to the outline over (angle, radius), > 0 inside
uniform vec4 outline_span;     // radii where the table begins and ends; tip radius; 1 = there are lifters

float distance_at(vec2 p) {
  float rho = length(p);
  float angle = atan(p.y, p.x) * 0.15915494;
  float found = texture(outline, vec2(angle, (rho - outline_span.x) / (outline_span.y - outline_span.x))).r;
  return outline_span.w < 0.5 ? 1.0 - rho : rho < outline_span.x ? outline_span.z - rho : found;
}

void main() {
  vec2 pixel = pixel_here();
  vec3 d = ray_of(pixel);
  vec3 unit = normalize(d);
  vec2 slope = d.xy / max(-d.z, 1e-3);
  vec2 at = eye.xy + slope * eye.z;  // on the inside of the glass
  vec2 front = eye.xy + slope * (eye.z - flange_size.z);
  float rho = length(at);
  if (flange_size.w > 0.5 ? max(rho, length(front)) > flange_size.x : rho > 1.04) discard;
  mat2 own = own_from_mill(pixel.y);
  vec2 p = own * at, way = own * slope;
  float run = max(length(slope), 1e-4), depth = clock.z, s = 0.0;
  float here = distance_at(p);
  bool end_face = here < 0.0, wall = false;
  if (!end_face) {
    for (int i = 0; i < 24; ++i) {
      s += max(here, 0.0015) / run;
      if (s >= depth) break;
      here = distance_at(p + way * s);
      if (here < 0.001) { wall = true; break; }
    }
    s = min(s, depth);
  }
  vec2 q = p + way * s;
  vec2 where = at + slope * s;
  number = 0.0;
  if (end_face || wall) {
    // The end face of a lifter or of the shell against the glass, or the shell's inside.
    float e = 0.004;
    vec2 g = vec2(distance_at(q + vec2(e, 0.0)) - distance_at(q - vec2(e, 0.0)),
                  distance_at(q + vec2(0.0, e)) - distance_at(q - vec2(0.0, e)));
    vec2 n = normalize(g * own + vec2(1e-6, 0.0));  // g * own: turned back
    vec3 normal = end_face ? vec3(0.0, 0.0, 1.0) : vec3(n, 0.0);
    vec3 along = end_face ? vec3(-at.y, at.x, 0.0) / rho : vec3(0.0, 0.0, 1.0);
    vec3 base = face_colour(2, end_face ? p : q * (1.0 + 0.3 * s), end_face ? rho : s * 1.3);
    vec2 shade = end_face ? vec2(0.75) : rim_shade(vec3(where, -s));
    light = vec4(lit(2, base, normal, along, unit, shade) * mix(end_face ? 0.8 : 1.0, 0.45, s / depth), 0.0);
    gl_FragDepth = depth_of(-s);
  } else {
    light = vec4(plate_light(where, q, distance_at(q), unit), 0.0);
    gl_FragDepth = depth_of(-depth);
  }
})";

// A quad that holds a ball's picture during the whole exposure.
inline constexpr const char* kBallVertex = R"(
layout(location = 0) in vec4 box;      // middle, half sizes [px]
layout(location = 1) in vec4 ball;     // centre, radius
layout(location = 2) in vec4 motion;   // velocity; row of the centre [px]; ball's number + 1
layout(location = 3) in vec4 turn;     // angle, spin; brightness; material
layout(location = 4) in vec4 colour;   // linear light; kind: 0 bare, 1 line, 2 half, 3 dots, 4 hollow
layout(location = 5) in vec4 crowd;    // where neighbours crowd; tilt of the mark
layout(location = 6) in vec4 chance;   // of noise; share of the lamps that reaches the ball
flat out vec4 ball_, motion_, turn_, colour_, crowd_, chance_;
out vec2 offset_;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  ball_ = ball; motion_ = motion; turn_ = turn; colour_ = colour; crowd_ = crowd; chance_ = chance;
  gl_Position = clip_from_image(box.xy + corner * box.zw);
})";

inline constexpr const char* kBallFragment = R"(
flat in vec4 ball_, motion_, turn_, colour_, crowd_, chance_;
uniform vec4 material_shine[4];   // metal, specular, exponent, translucent
uniform vec4 material_dirt[4];    // dirt, rust
uniform vec4 mark_look;           // width; occlusion; depth fade; hole
uniform vec3 mark_colour;
uniform vec3 surroundings;        // what a mirroring ball sees inside the mill
layout(location = 0) out vec4 light;
layout(location = 1) out float number;

void main() {
  vec2 pixel = pixel_here();
  vec3 d = normalize(ray_of(pixel));
  float dt = clock.x + clock.y * (pixel.y - motion_.z) / image_size.y;
  vec3 centre = ball_.xyz + vec3(motion_.xy * dt, 0.0);
  vec3 to = centre - eye;
  float b = dot(d, to);
  vec3 miss = to - b * d;
  float half_chord = ball_.w * ball_.w - dot(miss, miss);
  if (half_chord < 0.0) discard;
  half_chord = sqrt(half_chord);
  vec3 n = (-miss - half_chord * d) / ball_.w;
  gl_FragDepth = depth_of(centre.z + n.z * ball_.w);
  number = motion_.w;

  // The ball's own frame turns about the mill's axis.
  float angle = turn_.x + turn_.y * dt, ca = cos(angle), sa = sin(angle);
  vec3 m = vec3(ca * n.x + sa * n.y, ca * n.y - sa * n.x, n.z);
  int kind = int(turn_.w + 0.5);
  vec4 shine = material_shine[kind];
  vec4 dirt = material_dirt[kind];
  vec2 skin = m.xy * 0.13 + chance_.xy + m.z * vec2(0.03, 0.05);
  vec4 coarse = texture(noise, skin), fine = texture(noise, skin * 3.1);
  vec3 base = colour_.rgb * turn_.z;
  base *= 1.0 + dirt.x * (1.5 * (coarse.r - 0.5) + 0.8 * (fine.b - 0.5));
  float metal = shine.x, specular = shine.y;
  float rusty = smoothstep(0.0, 0.15, coarse.g * 0.7 + fine.g * 0.3 - (0.86 - 0.62 * dirt.y)) * step(0.001, dirt.y);
  base = mix(max(base, 0.0), vec3(0.22, 0.10, 0.05) * (0.5 + fine.r), 0.8 * rusty);
  metal *= 1.0 - 0.8 * rusty;
  specular *= 1.0 - 0.7 * rusty;

  float soft = 0.9 / max(pinhole.x * ball_.w / max(b, 0.1), 1.0);  // a pixel over the ball's radius
  float mark = 0.0, ct = cos(crowd_.w), st = sin(crowd_.w);
  float across = ct * m.y + st * m.z, hole = 0.0;
  if (colour_.w > 0.5 && colour_.w < 1.5) {
    mark = clamp((mark_look.x - abs(across)) / soft + 0.5, 0.0, 1.0);
  } else if (colour_.w > 1.5 && colour_.w < 2.5) {
    mark = clamp(across / soft + 0.5, 0.0, 1.0);
  } else if (colour_.w > 2.5 && colour_.w < 3.5) {
    float size = 2.0 * mark_look.x;
    float near = min(min(length(m - vec3(0.55, 0.0, 0.835)), length(m - vec3(-0.5, 0.5, 0.707))),
                     length(m - vec3(-0.1, -0.75, 0.654)));
    mark = clamp((size - near) / soft + 0.5, 0.0, 1.0);
  } else if (colour_.w > 3.5) {
    vec3 axis = normalize(vec3(cos(crowd_.w * 3.0), sin(crowd_.w * 3.0), 0.4 + chance_.x));
    float off = length(m - dot(m, axis) * axis);
    hole = clamp((mark_look.w - off) / soft + 0.5, 0.0, 1.0);
    base *= 1.0 + 0.5 * clamp(1.0 - abs(off - mark_look.w - 0.08) / 0.08, 0.0, 1.0);
  }
  base = mix(base, mark_colour, mark);
  metal *= 1.0 - mark;

  float nook = 1.0 - mark_look.y * max(dot(n, crowd_.xyz), 0.0);
  nook *= mix(1.0, 0.35 + 0.65 * smoothstep(-0.05, 0.75, n.z), mark_look.y);
  vec3 seen = reflect(d, n);
  vec3 ambient = mix(below, above, 0.5 + 0.5 * n.y);
  float murk = texture(noise, seen.xy * 0.17 + chance_.yx).g;
  float open = smoothstep(0.1, 0.75, seen.z);
  vec3 mirrored = mix(surroundings * (0.4 + 1.2 * murk), mix(below, above, smoothstep(-0.35, 0.45, seen.y + 0.5 * (murk - 0.5))), open);
  vec3 c = base * ambient * (1.0 - 0.75 * metal) + base * mirrored * 1.5 * metal;
  for (int i = 0; i < lamp_count; ++i) {
    vec3 l = lamp_towards[i];
    float reach = chance_[2 + i], wrap = 0.5 * lamp_size[i];
    float diffuse = max((dot(n, l) + wrap) / (1.0 + wrap), 0.0);
    vec3 h = normalize(l - d);
    float exponent = shine.z / (1.0 + shine.z * lamp_size[i] * lamp_size[i]);
    float glint = pow(max(dot(n, h), 0.0), exponent) * (0.3 + 0.012 * exponent);
    float fresnel = 0.06 + 0.5 * metal + 0.4 * pow(1.0 - max(n.z, 0.0), 4.0);
    c += lamp_colour[i] * reach * (base * diffuse * (1.0 - 0.55 * metal) +
         glint * specular * fresnel * mix(vec3(1.0), base / max(max(base.r, max(base.g, base.b)), 1e-3), 0.7 * metal));
    float gathered = pow(max(dot(n, -normalize(vec3(l.xy, -0.35 * l.z))), 0.0), 2.5);
    c += lamp_colour[i] * base * (shine.w * 1.4 * gathered);
  }
  c *= nook * (1.0 - mark_look.z * clamp(-(centre.z + ball_.w) / clock.z, 0.0, 1.0));
  c = mix(c, c * 0.06 + 0.003, hole);
  light = vec4(c, 1.0);
})";

// A ball's soft shadow on the back plate: a quad as large as the shadow, darkest in its middle.
inline constexpr const char* kShadowVertex = R"(
layout(location = 0) in vec4 box;     // middle, half sizes [px]
layout(location = 1) in vec4 shadow;  // centre on the plate, radius, softness
layout(location = 2) in vec4 motion;  // velocity; row of the centre [px]; darkness
flat out vec4 shadow_, motion_;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  shadow_ = shadow; motion_ = motion;
  gl_Position = clip_from_image(box.xy + corner * box.zw);
})";

inline constexpr const char* kShadowFragment = R"(
flat in vec4 shadow_, motion_;
layout(location = 0) out vec4 light;
layout(location = 1) out float number;
void main() {
  vec2 pixel = pixel_here();
  vec3 d = ray_of(pixel);
  vec2 at = eye.xy + d.xy / max(-d.z, 1e-3) * (eye.z + clock.z);
  float dt = clock.x + clock.y * (pixel.y - motion_.z) / image_size.y;
  float off = length(at - shadow_.xy - motion_.xy * dt);
  float dark = motion_.w * (1.0 - smoothstep(shadow_.z - shadow_.w, shadow_.z + shadow_.w, off));
  number = 0.0;
  light = vec4(0.0, 0.0, 0.0, dark);
  gl_FragDepth = depth_of(-clock.z) - 1e-4;
})";

// What sticks to the turning glass, over all that is behind it.
inline constexpr const char* kGlassFragment = R"(
uniform sampler2D on_glass;   // over the mill's own frame from -1.5 to 1.5
uniform vec2 turning;
uniform float mirror;
layout(location = 0) out vec4 light;
void main() {
  vec2 pixel = pixel_here();
  vec3 d = ray_of(pixel);
  vec2 at = eye.xy + d.xy / max(-d.z, 1e-3) * eye.z;
  float angle = turning.x + turning.y * row_time(pixel.y), c = cos(angle), s = sin(angle);
  light = texture(on_glass, mat2(c * mirror, -s * mirror, s, c) * at / 3.0 + 0.5) * step(dot(at, at), 1.1);
})";

// Adds a sub-exposure to the sum.
inline constexpr const char* kSumFragment = R"(
uniform sampler2D picture;
uniform float share;
out vec4 sum;
void main() { sum = texelFetch(picture, ivec2(gl_FragCoord.xy), 0) * share; })";

}  // namespace tumble::render::film
