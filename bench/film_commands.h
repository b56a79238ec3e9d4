#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

// The two things that make_films makes.
namespace tumble::films {

struct PictureOrder {
  std::filesystem::path folder;
  std::uint64_t seed = 1;
  int count = 10, mills = 40;
  int level = -1;  // any
  std::optional<std::uint64_t> mill_seed;
};
void make_pictures(const PictureOrder& order);

struct FilmOrder {
  std::filesystem::path file;
  std::uint64_t seed = 1;
  int level = 1;
  double seconds = 2, fps = 120;  // of the mill's own time; as recorded
};
void make_film(const FilmOrder& order);

}  // namespace tumble::films
