#pragma once

namespace tumble {

inline constexpr const char* kVersion = TUMBLE_VERSION;  // of this program, from CMakeLists.txt

}  // namespace tumble
