#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

// The things that make_films makes.
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

// What the film's mill does over `times` as long as it is filmed, beside what it does in the film: a JSON file. A film
// is a short sample, and whoever measures it wants to know of the mill.
void make_long_run(const FilmOrder& order, double times);

}  // namespace tumble::films
