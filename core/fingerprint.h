#pragma once
#include <cstdint>
#include <string_view>

namespace tumble {

// FNV-1a, 64 bits: among a million texts two alike are a matter of one in 40 million.
inline std::uint64_t fingerprint(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

}  // namespace tumble
