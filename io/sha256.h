#pragma once
#include <string>
#include <string_view>

namespace tumble::io {

// SHA-256 (FIPS 180-4) of these bytes, as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

}  // namespace tumble::io
