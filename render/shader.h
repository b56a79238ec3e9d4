#pragma once
#include <cstddef>

#include "render/gl.h"

namespace tumble::render {

// Pixel coordinates (u to the right, v down, integer = pixel centre; core/image.h) to clip space; every vertex shader
// starts with it.
inline constexpr const char* kClipFromImage = R"(#version 330 core
uniform vec2 image_size;
vec4 clip_from_image(vec2 p) {
  vec2 q = (p + 0.5) / image_size * 2.0 - 1.0;
  return vec4(q.x, -q.y, 0.0, 1.0);
}
)";

// A linked program, its vertex array and its one streamed buffer: what each kind of primitive owns.
// The context must be current for every call, and outlive it: GL frees the rest with the context.
struct Pipeline {
  GLuint program = 0, vertex_array = 0, buffer = 0;
};

// `vertex` is appended to kClipFromImage. Throws WorkError with the compiler's log.
Pipeline make_pipeline(const char* vertex, const char* fragment, int width, int height);

// Describes attribute `index` of the pipeline's buffer. `divisor` 1: one value per instance.
void set_attribute(const Pipeline& pipeline, GLuint index, int components, GLenum type, bool normalised, int stride,
                   std::size_t offset, GLuint divisor = 0);

}  // namespace tumble::render
