#include "cli/film_beside.h"
#include "cli/program.h"

// `tumble-render`: the one verb that draws but reads no films (see main.cpp).
int main(int argc, char** argv) {
  using namespace tumble::cli;
  constexpr AddVerb kVerbs[] = {[](CLI::App& app) { add_render(app, nullptr); }};
  return run_program(argc, argv, kVerbs);
}
