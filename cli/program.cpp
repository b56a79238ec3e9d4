#include "cli/program.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "cli/console.h"
#include "core/error.h"
#include "core/version.h"

namespace tumble::cli {
namespace {

// CLI11 would only say that a verb is missing.
void check_verb(const CLI::App& app, const std::string& word) {
  if (word.empty() || word[0] == '-') return;
  std::string known;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (verb->get_name() == word) return;
    known += (known.empty() ? "" : ", ") + verb->get_name();
  }
  throw InputError(word, "unknown verb; known: " + known);
}

}  // namespace

int fail(const std::string& line, int status) {
  std::string flat = line;
  for (char& c : flat)
    if (c == '\n' || c == '\r') c = ' ';
  while (!flat.empty() && flat.back() == ' ') flat.pop_back();
  std::fprintf(stderr, "tumble: %s\n", flat.c_str());
  return status;
}

int run_program(int argc, char** argv, std::span<const AddVerb> verbs) try {
  CLI::App app{"tumble: simulate, animate, film back and compare the charge of a tumbling mill", "tumble"};
  app.set_version_flag("--version", std::string("tumble ") + kVersion);
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& e) { return std::string(e.what()) + "\n"; });
  for (const AddVerb add : verbs) add(app);
  app.footer("Example: tumble run examples/lab_mill_55cm.toml -o out\nEach verb has its own help: tumble run --help");

  try {
    catch_signals();
    if (argc > 1) check_verb(app, argv[1]);
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    return fail(std::string(e.what()) + "; see tumble --help", 2);
  } catch (const Error& e) {
    return fail(e.what(), static_cast<int>(e.kind()));
  }
  return 0;
} catch (const std::bad_alloc&) {
  return fail("out of memory; use fewer balls or frames", 1);
} catch (const std::exception& e) {
  return fail(e.what(), 1);
}

}  // namespace tumble::cli
