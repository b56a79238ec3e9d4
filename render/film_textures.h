#pragma once
#include "render/gl.h"

namespace tumble::render {

// A texture that is read smoothly; `wrap`: GL_REPEAT or GL_CLAMP_TO_EDGE.
GLuint make_texture(GLint wrap);
void fill_texture(GLuint name, GLint format, GLenum channels, int width, int height, const float* data);

// Noise of four kinds, that repeats: two sorts of clouds, fine grain, and clouds of middling size.
void fill_with_noise(GLuint name);

}  // namespace tumble::render
