#include "cli/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "core/error.h"

namespace tumble::cli {
namespace {

volatile std::sig_atomic_t g_asked_to_stop = 0;

void remember(int) { g_asked_to_stop = 1; }

std::string duration(double seconds) {
  if (!(seconds < 100 * 24 * 3600)) return "months";  // a guess from the first moments
  const int s = static_cast<int>(seconds + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

}  // namespace

void catch_signals() {
  struct sigaction action = {};
  action.sa_handler = remember;
  action.sa_flags = SA_RESETHAND;  // a second Ctrl-C ends the process at once
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is an error of the write
}

void stop_if_asked(const std::string& what_was_done) {
  if (g_asked_to_stop) throw Interrupted(what_was_done);
}

void say(const CommonOptions& options, const std::string& line) {
  if (!options.quiet) fmt::print(stderr, "{}\n", line);
}

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw WorkError("standard output", std::string("cannot be written: ") + std::strerror(errno));
}

ProgressLine::ProgressLine(const CommonOptions& options, std::string label, std::string if_stopped)
    : quiet_(options.quiet),
      terminal_(isatty(STDERR_FILENO) != 0),
      label_(std::move(label)),
      if_stopped_(std::move(if_stopped)),
      start_(std::chrono::steady_clock::now()),
      shown_(start_) {}

ProgressLine::~ProgressLine() {
  if (drawn_ && terminal_) fmt::print(stderr, "\r\033[K");
  if (!quiet_ && seconds() >= 1) fmt::print(stderr, "{}: {}\n", label_, duration(seconds()));
}

double ProgressLine::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

Progress ProgressLine::callback() {
  return [this](double done) { show(done); };
}

void ProgressLine::show(double done) {
  stop_if_asked(if_stopped_);
  if (quiet_) return;
  done = std::clamp(done, 0.0, 1.0);  // a run that ends on a whole frame may pass its plan
  if (first_ < 0) first_ = done;
  const auto now = std::chrono::steady_clock::now();
  const double since = std::chrono::duration<double>(now - shown_).count();
  if (seconds() < 1 || since < (terminal_ ? 0.1 : 10.0)) return;
  shown_ = now;
  drawn_ = true;
  const double rate = (done - first_) / seconds();
  const std::string left = rate > 0 ? duration((1 - done) / rate) + " left" : "";
  if (!terminal_) {
    fmt::print(stderr, "{}: {:.0f} %, {}\n", label_, 100 * done, left);
    return;
  }
  const int filled = static_cast<int>(done * 30);
  fmt::print(stderr, "\r\033[K{} [{:=<{}}{:<{}}] {:3.0f} %  {}", label_, "", filled, "", 30 - filled, 100 * done, left);
  std::fflush(stderr);
}

}  // namespace tumble::cli
