#pragma once
#include <string>

#include "core/image.h"

namespace tumble::io {

// PNG (libpng), written beside `path` and renamed. Throws WorkError with the path and the system's reason.
void write_png(const std::string& path, const Image& image);

}  // namespace tumble::io
