#pragma once
#include <vector>

#include "core/drawing.h"

namespace tumble::render {

// Lets a kind of primitive go into a drawing instead of being drawn: shapes wait for flush() there too, so that what
// lies above what is decided as in a picture.
class Recorder {
 public:
  void record_into(Drawing* drawing) { drawing_ = drawing; }  // nullptr: no more
  bool is_on() const { return drawing_ != nullptr; }
  void add(Drawing::Shape&& shape);
  void flush();

 private:
  Drawing* drawing_ = nullptr;
  std::vector<Drawing::Shape> waiting_;
};

}  // namespace tumble::render
