#include "cli/program.h"
#include "trials/verbs.h"

// `tumble-trials`: a program of its own, so that what hides in blind trials is in no other (docs/trials.md). `tumble
// trials` hands over to it.
int main(int argc, char** argv) {
  using namespace tumble;
  constexpr cli::AddVerb kVerbs[] = {[](CLI::App& app) {
    CLI::App* verb =
        app.add_subcommand("trials", "Blind data sets with a sealed key, and the score of verdicts on them");
    verb->require_subcommand(1);
    trials::add_make(*verb);
    trials::add_score(*verb);
  }};
  return cli::run_program(argc, argv, kVerbs);
}
