#include "render/film_textures.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/random.h"
#include "render/paint.h"

namespace tumble::render {
namespace {

constexpr int kNoiseSize = 256;

std::vector<float> noise_texels() {
  std::vector<float> texels(static_cast<std::size_t>(kNoiseSize) * kNoiseSize * 4);
  Random random(99);
  for (int j = 0; j < kNoiseSize; ++j)
    for (int i = 0; i < kNoiseSize; ++i) {
      float* p = texels.data() + 4 * (static_cast<std::size_t>(j) * kNoiseSize + i);
      const double x = double(i) / kNoiseSize, y = double(j) / kNoiseSize;
      const auto stretched = [](double value) {
        return static_cast<float>(std::clamp(0.5 + 1.5 * (value - 0.5), 0.0, 1.0));
      };
      p[0] = stretched(cloudy_noise(6 * x, 6 * y, 6, 5, 1));
      p[1] = stretched(cloudy_noise(9 * x, 9 * y, 9, 5, 2));
      p[2] = static_cast<float>(0.6 * random.uniform() + 0.4 * smooth_noise(90 * x, 90 * y, 90, 3));
      p[3] = stretched(cloudy_noise(24 * x, 24 * y, 24, 3, 4));
    }
  return texels;
}

}  // namespace

GLuint make_texture(GLint wrap) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
  return name;
}

void fill_texture(GLuint name, GLint format, GLenum channels, int width, int height, const float* data) {
  glBindTexture(GL_TEXTURE_2D, name);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, channels, GL_FLOAT, data);
}

void fill_with_noise(GLuint name) {
  fill_texture(name, GL_RGBA16F, GL_RGBA, kNoiseSize, kNoiseSize, noise_texels().data());
}

}  // namespace tumble::render
