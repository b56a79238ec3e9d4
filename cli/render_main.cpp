#include "cli/program.h"
#include "cli/verbs.h"

// `tumble-render`: the one verb that draws but reads no films (see main.cpp).
int main(int argc, char** argv) {
  using namespace tumble::cli;
  constexpr AddVerb kVerbs[] = {add_render};
  return run_program(argc, argv, kVerbs);
}
