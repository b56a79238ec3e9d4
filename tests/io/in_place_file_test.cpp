#include "io/in_place_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "tests/io/folder.h"

namespace tumble::io {
namespace {

class InPlaceFileTest : public InFolder {};

// Pieces that go through memory and pieces that go through calls, some over others: a reader sees each at once.
TEST_F(InPlaceFileTest, ReadersSeeEveryPieceAtOnce) {
  std::string wanted(9'000'000, '\0');
  const auto path = folder_ / "file";
  write_bytes(path, wanted);
  InPlaceFile file(path, path);
  file.reserve();
  const auto put = [&](std::size_t offset, std::size_t size, char c) {
    const std::string piece(size, c);
    file.write(offset, piece.data(), size);
    wanted.replace(offset, size, piece);
  };
  constexpr std::array<std::size_t, 5> kSizes{8, 1000, 4096, 5000, 70000};
  std::size_t at = 1;
  for (int k = 0; at < wanted.size(); ++k) {
    const std::size_t size = std::min(kSizes[static_cast<std::size_t>(k % 5)], wanted.size() - at);
    put(at, size, static_cast<char>('a' + k % 23));
    at += size - size / 10;
  }
  EXPECT_TRUE(bytes_of(path) == wanted);
  for (std::size_t k = 0; k + 4096 <= wanted.size(); k += 4000) put(k, 4096, static_cast<char>('A' + k % 23));
  EXPECT_TRUE(bytes_of(path) == wanted);
  put(wanted.size() - 8, 8, 'z');
  EXPECT_TRUE(bytes_of(path) == wanted);
  std::string back(100, ' ');
  file.read(5'000'000, back.data(), back.size());
  EXPECT_EQ(back, wanted.substr(5'000'000, 100));
}

}  // namespace
}  // namespace tumble::io
