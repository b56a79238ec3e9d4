#include "render/shader.h"

#include <string>

#include "core/error.h"

namespace tumble::render {
namespace {

GLuint compile(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    char log[1024] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw WorkError("render", std::string("shader does not compile: ") + log);
  }
  return shader;
}

}  // namespace

Pipeline make_pipeline(const char* vertex, const char* fragment, int width, int height) {
  Pipeline pipeline;
  const GLuint vertex_shader = compile(GL_VERTEX_SHADER, std::string(kClipFromImage) + vertex);
  const GLuint fragment_shader = compile(GL_FRAGMENT_SHADER, std::string("#version 330 core\n") + fragment);
  pipeline.program = glCreateProgram();
  glAttachShader(pipeline.program, vertex_shader);
  glAttachShader(pipeline.program, fragment_shader);
  glLinkProgram(pipeline.program);
  glDeleteShader(vertex_shader);
  glDeleteShader(fragment_shader);
  GLint good = 0;
  glGetProgramiv(pipeline.program, GL_LINK_STATUS, &good);
  if (!good) {
    char log[1024] = "";
    glGetProgramInfoLog(pipeline.program, sizeof log, nullptr, log);
    throw WorkError("render", std::string("shaders do not link: ") + log);
  }
  glUseProgram(pipeline.program);
  glUniform2f(glGetUniformLocation(pipeline.program, "image_size"), static_cast<float>(width),
              static_cast<float>(height));
  glGenVertexArrays(1, &pipeline.vertex_array);
  glGenBuffers(1, &pipeline.buffer);
  return pipeline;
}

void set_attribute(const Pipeline& pipeline, GLuint index, int components, GLenum type, bool normalised, int stride,
                   std::size_t offset, GLuint divisor) {
  glBindVertexArray(pipeline.vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, pipeline.buffer);
  glEnableVertexAttribArray(index);
  glVertexAttribPointer(index, components, type, normalised ? GL_TRUE : GL_FALSE, stride,
                        reinterpret_cast<const void*>(offset));
  glVertexAttribDivisor(index, divisor);
}

}  // namespace tumble::render
