#include "io/sha256.h"

extern "C" {
#include <libavutil/mem.h>
#include <libavutil/sha.h>
}
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <memory>
#include <new>

// By libavutil, which films are written with anyway.
namespace tumble::io {

std::string sha256(std::string_view bytes) {
  const std::unique_ptr<AVSHA, decltype(&av_free)> sum(av_sha_alloc(), av_free);
  if (!sum) throw std::bad_alloc();
  av_sha_init(sum.get(), 256);
  av_sha_update(sum.get(), reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  std::array<std::uint8_t, 32> digest{};
  av_sha_final(sum.get(), digest.data());
  std::string text;
  for (const std::uint8_t byte : digest) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace tumble::io
