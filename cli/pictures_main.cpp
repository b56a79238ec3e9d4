#include "cli/program.h"
#include "cli/verbs.h"

// `tumble-pictures`: every verb (see main.cpp).
int main(int argc, char** argv) {
  using namespace tumble::cli;
  constexpr AddVerb kVerbs[] = {add_run,        add_simulate, add_render,    add_analyse, add_compare,
                                add_parameters, add_sweep,    add_calibrate, add_effects, add_shell};
  return run_program(argc, argv, kVerbs);
}
