#include "render/picture_quad.h"

namespace tumble::render {
namespace {

constexpr const char* kVertex = R"(
layout(location = 0) in vec4 corner;  // place in the picture, texel
out vec2 place;
void main() {
  place = corner.zw;
  gl_Position = clip_from_image(corner.xy);
})";

// Texels fall on pixels one to one, so they are fetched, not filtered.
constexpr const char* kFragment = R"(
in vec2 place;
uniform sampler2D image;
out vec4 pixel;
void main() {
  vec4 texel = texelFetch(image, ivec2(floor(place)), 0);
  pixel = vec4(texel.rgb * texel.a, texel.a);
})";

}  // namespace

PictureQuad::PictureQuad(int width, int height) : pipeline_(make_pipeline(kVertex, kFragment, width, height)) {
  set_attribute(pipeline_, 0, 4, GL_FLOAT, false, 4 * sizeof(float), 0);
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void PictureQuad::draw(const Image& image, int left, int top) {
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  const auto w = static_cast<float>(image.width), h = static_cast<float>(image.height);
  const float x0 = static_cast<float>(left) - 0.5f, y0 = static_cast<float>(top) - 0.5f;  // edges of pixels
  const float corners[] = {x0, y0, 0, 0, x0 + w, y0,     w, 0, x0 + w, y0 + h, w, h,
                           x0, y0, 0, 0, x0 + w, y0 + h, w, h, x0,     y0 + h, 0, h};
  glUseProgram(pipeline_.program);
  glBindVertexArray(pipeline_.vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, pipeline_.buffer);
  glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STREAM_DRAW);
  glDrawArrays(GL_TRIANGLES, 0, 6);
}

}  // namespace tumble::render
