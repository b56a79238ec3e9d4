#pragma once
#include <chrono>
#include <string>

#include "core/progress.h"

namespace tumble::cli {

// What every verb shares.
struct CommonOptions {
  bool quiet = false;
  bool json = false;
  bool force = false;
  int threads = 0;  // 0 = all
};

// From now on Ctrl-C and SIGTERM set a flag instead of ending the process; a broken pipe is an error, not the end.
void catch_signals();

// Throws Interrupted, with what became of the work, once a signal has come.
void stop_if_asked(const std::string& what_was_done);

// A line on standard error, unless quiet.
void say(const CommonOptions& options, const std::string& line);

// The whole text on standard output. Throws WorkError where that fails (closed pipe, full disk).
void print(const std::string& text);

// One line on standard error with share done and time left. Silent when quiet and for work of under a second; redrawn
// in place on a terminal, a line every ten seconds elsewhere. Throws Interrupted(`if_stopped`) after a signal.
class ProgressLine {
 public:
  ProgressLine(const CommonOptions& options, std::string label, std::string if_stopped);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  Progress callback();
  double seconds() const;  // since the start

 private:
  void show(double done);

  bool quiet_;
  bool terminal_;
  std::string label_, if_stopped_;
  std::chrono::steady_clock::time_point start_, shown_;
  double first_ = -1;  // share done when first heard of: a resumed run does not start at 0
  bool drawn_ = false;
};

}  // namespace tumble::cli
