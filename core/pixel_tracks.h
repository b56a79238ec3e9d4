#pragma once
#include <string>
#include <vector>

namespace tumble {

struct PixelSighting {  // one ball seen in one picture of a film
  int track = 0;        // sightings of one ball share it
  int frame = 0;        // of the film, >= 0
  double u = 0, v = 0;  // centre, v down [px]
  double radius = 0;    // as seen [px], > 0
};

// Balls that another program has followed through a film.
struct PixelTracks {
  std::string name;  // of the file, for messages
  std::vector<PixelSighting> sightings;
};

}  // namespace tumble
