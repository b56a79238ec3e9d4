#pragma once
#include <stdexcept>
#include <string>

namespace tumble {

// What a user can mend. One line: "place: what is wrong; what would be right".
// Rooms throw it and never print or exit; cli/main.cpp catches once and turns the kind into the exit status.
class Error : public std::runtime_error {
 public:
  enum class Kind { kWorkFailed = 1, kInputWrong = 2 };  // the value is the exit status

  Error(Kind kind, const std::string& place, const std::string& problem)
      : std::runtime_error(place.empty() ? problem : place + ": " + problem), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

// The option, config or data are wrong (exit status 2).
class InputError : public Error {
 public:
  InputError(const std::string& place, const std::string& problem) : Error(Kind::kInputWrong, place, problem) {}
};

// The file, the device or the run failed (exit status 1).
class WorkError : public Error {
 public:
  WorkError(const std::string& place, const std::string& problem) : Error(Kind::kWorkFailed, place, problem) {}
};

// The user asked to stop (Ctrl-C, SIGTERM): thrown by a progress callback, passes through every room.
class Interrupted : public WorkError {
 public:
  explicit Interrupted(const std::string& what_was_done) : WorkError("interrupted", what_was_done) {}
};

}  // namespace tumble
