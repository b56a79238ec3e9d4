#include "cli/film_beside.h"
#include "cli/program.h"
#include "cli/verbs.h"

// `tumble-pictures`: every verb (see main.cpp).
int main(int argc, char** argv) {
  using namespace tumble::cli;
  constexpr AddVerb kRender = [](CLI::App& app) { add_render(app, render_beside); };
  // For the list of verbs alone: `tumble` hands over to the program that has it.
  constexpr AddVerb kTrials = [](CLI::App& app) {
    app.add_subcommand("trials", "Blind data sets with a sealed key, and the score of verdicts on them");
  };
  constexpr AddVerb kVerbs[] = {add_run,   add_simulate,  kRender,      add_analyse, add_compare, add_parameters,
                                add_sweep, add_calibrate, add_diagnose, add_effects, add_shell,   kTrials};
  return run_program(argc, argv, kVerbs);
}
