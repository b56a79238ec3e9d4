#pragma once
// The one place where OpenGL's headers are chosen: core profile, prototypes from libOSMesa itself, no loader.
#define GL_GLEXT_PROTOTYPES 1
#include <GL/gl.h>
#include <GL/glext.h>
