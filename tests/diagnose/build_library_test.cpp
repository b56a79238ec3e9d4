#include "diagnose/build_library.h"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <map>

#include "core/error.h"

namespace tumble::diagnose {
namespace {

using Rows = std::vector<std::vector<float>>;

// Six balls: the library's runs take eight revolutions.
Config mill() {
  Config config;
  config.mill.diameter = 0.2;
  config.mill.speed = 0.6;
  config.charge.count = 6;
  config.charge.balls = {{0.01, 0.03, 1}};
  config.run.spin_up = 0.1;
  config.contact.normal_stiffness = config.contact.tangential_stiffness = 5e3;  // soft: longer steps
  return config;
}

Config with(const Config& config, const std::vector<std::string>& sets) {
  Config changed = config;
  for (const std::string& set : sets) {
    const double value = std::stod(set.substr(set.find('=') + 1));
    if (set.starts_with("contact.restitution=")) {
      if (value > 1) throw InputError("contact.restitution", "is above 1");
      changed.contact.restitution = value;
    } else if (set.starts_with("mill.speed=")) {
      changed.mill.speed = value;
    }
  }
  return changed;
}

std::string bits(const std::vector<float>& row) {  // what is not known (NaN) included
  return {reinterpret_cast<const char*>(row.data()), row.size() * sizeof(float)};
}

class BuildLibrary : public testing::Test {
 protected:
  std::size_t build(std::size_t most_chunks) {
    std::vector<Condition> conditions{make_condition(mill(), keys_, {0.95}, "a mill")};
    conditions[0].suspects.resize(1);  // one, to be quick
    LibrarySink sink;
    sink.read = [&](std::size_t, std::size_t chunk, Rows& rows) {
      const auto found = files_.find(chunk);
      if (found != files_.end()) rows = found->second;
      return found != files_.end();
    };
    sink.write = [&](std::size_t, std::size_t chunk, const Rows& rows) {
      if (files_.size() == most_chunks) throw Interrupted("one chunk");
      files_[chunk] = rows;
    };
    const std::size_t simulated = build_library(conditions, keys_, 1, with, sink);
    runs_ = conditions[0].runs;
    return simulated;
  }

  std::vector<UncertainKey> keys_{{"contact.restitution", 0.05, ""}};
  std::map<std::size_t, Rows> files_;
  std::vector<SignatureRun> runs_;
};

TEST_F(BuildLibrary, GoesOnWhereItWasInterruptedAndThenSimulatesNothing) {
  EXPECT_THROW(build(1), Interrupted);
  const std::size_t all = plan_block(0, 1, {make_condition(mill(), keys_, {0.95}, "").suspects[0]}).size();
  EXPECT_LT(build(99), all);
  const auto first = runs_;
  EXPECT_EQ(first.size(), all);
  EXPECT_EQ(build(99), 0u);
  ASSERT_EQ(runs_.size(), first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(runs_[i].uncertain, first[i].uncertain);
    EXPECT_EQ(bits(pack(runs_[i])), bits(pack(first[i])));
  }
}

// 0.95 + 2.3 x 0.05 is a restitution that no ball has.
TEST_F(BuildLibrary, ValuesThatNoMillCanHaveGiveWay) {
  build(99);
  double most = 0;
  for (const SignatureRun& run : runs_) most = std::max(most, run.uncertain[0]);
  EXPECT_LE(0.95 + 0.05 * most, 1);
  EXPECT_GT(most, 0.5);
}

}  // namespace
}  // namespace tumble::diagnose
