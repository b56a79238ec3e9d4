#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/deviation.h"
#include "core/mill_shape.h"

// What `tumble compare` writes.
namespace tumble::io {

struct ComparedFilm {  // small, to be shown beside the other one; none where `file` is empty
  std::filesystem::path file = {};
  std::string caption = {};
};

struct ComparedSource {
  const ChargeMotion* motion = nullptr;
  MillShape shape = {};              // as much of it as is known
  std::vector<BallPath> paths = {};  // of single balls
  ComparedFilm film = {};
};

struct Comparison {
  ComparedSource a, b;
  const Deviation* deviation = nullptr;
  std::string film_note = {};  // how the films keep step; empty without two films
  double film_rate = 30;       // pictures per second of the films
  double film_slow = 1;        // how many times slower than true time they run
  std::string version = {};
};

// deviation.json: every difference with its standard error and z; docs/compare.md.
std::string deviation_json(const Comparison& comparison);
// The same without lines, fields and what agrees in them: what --json prints.
std::string deviation_summary(const Comparison& comparison);

// report.html: one self-contained file. Throws WorkError where a film cannot be read.
std::string comparison_page(const Comparison& comparison);

}  // namespace tumble::io
