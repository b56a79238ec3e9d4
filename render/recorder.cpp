#include "render/recorder.h"

#include <iterator>
#include <utility>

namespace tumble::render {

void Recorder::add(Drawing::Shape&& shape) { waiting_.push_back(std::move(shape)); }

void Recorder::flush() {
  std::move(waiting_.begin(), waiting_.end(), std::back_inserter(drawing_->shapes));
  waiting_.clear();
}

}  // namespace tumble::render
