#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "cli/program.h"
#include "cli/tasks.h"
#include "cli/verbs.h"

// Films and pictures need OpenCV, libav and OSMesa, which bring 250 libraries: to load them takes a quarter of a second
// and 120 MB, more than a small mill's simulation. So `tumble` is four programs: this one has the verbs without
// pictures, `tumble-render` beside it draws films and need not load OpenCV, and `tumble-pictures` has all verbs and
// takes over for everything else. `tumble-trials` stands apart: what hides in blind trials is in no other program.
// Rejected: to load the pictures' half with dlopen, which would hold the rooms' state
// (locks, threads, signals) twice in one process.
namespace {

using namespace tumble::cli;
struct Verb {
  std::string_view name;
  AddVerb add;
};
constexpr Verb kWithoutPictures[] = {
    {"simulate", add_simulate}, {"sweep", add_sweep}, {"parameters", add_parameters},
    {"effects", add_effects},   {"shell", add_shell}, {"task", add_task},
};

int hand_over(const char* program, char** argv) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path other = self.parent_path() / program;
  execv(other.c_str(), argv);
  return fail(other.string() + ": cannot be run (" + std::strerror(errno) + "); it belongs beside " + self.string(), 1);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view word = argc > 1 ? argv[1] : "";
  for (const Verb& verb : kWithoutPictures)
    if (verb.name == word) return run_program(argc, argv, {&verb.add, 1});
  if (word == "trials") return hand_over("tumble-trials", argv);
  if (word == "--version" && argc == 2) return run_program(argc, argv, {});
  const bool reads_film =
      std::any_of(argv, argv + argc, [](const char* a) { return std::string_view(a).starts_with("--beside"); });
  return hand_over(word == "render" && !reads_film ? "tumble-render" : "tumble-pictures", argv);
}
