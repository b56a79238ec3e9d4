#include "core/effects.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "io/config_file.h"

namespace tumble {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = TUMBLE_SOURCE_DIR;

std::string text_of(const fs::path& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}
bool says(const std::string& text, const std::string& word) { return text.find(word) != std::string::npos; }

// A row of the registry, its physics, its example and its page belong together: none comes without the others.
TEST(Effects, EachHasItsFile) {
  for (const Effect& effect : all_effects()) {
    const std::string name = effect.name;
    if (fs::exists(kSource / "sim/effects" / (name + ".h"))) continue;
    // What changes the shell's shape is the geometry's.
    EXPECT_STREQ(effect.acts_on, "shell") << name;
    EXPECT_TRUE(says(text_of(kSource / "core/mill_shape.cpp"), name)) << name;
  }
  for (const auto& file : fs::directory_iterator(kSource / "sim/effects"))
    EXPECT_TRUE(find_effect(file.path().stem().string())) << file.path();
}

TEST(Effects, EachHasAnExampleWithItAlone) {
  for (const Effect& effect : all_effects()) {
    const fs::path path = kSource / "examples/effects" / (std::string(effect.name) + ".toml");
    const Config config = io::read_config(path);
    EXPECT_NO_THROW(check_complete(config)) << path;
    for (const Effect& other : all_effects())
      EXPECT_EQ(has_effect(config, other.name), &other == &effect) << path << ": " << other.name;
    // One strength at least is the typical one, and no parameter goes unnamed.
    bool typical = false;
    for (const EffectParameter& p : effect.parameters) {
      typical |= (p.list && p.strength) || (p.strength && effect_value(config, effect.name, p.name) == p.typical);
      EXPECT_TRUE(says(text_of(path), std::string(p.name) + " = ")) << path << ": " << p.name;
    }
    EXPECT_TRUE(typical) << path;
  }
  for (const auto& file : fs::directory_iterator(kSource / "examples/effects"))
    EXPECT_TRUE(find_effect(file.path().stem().string())) << file.path();
}

TEST(Effects, EachHasAPageThatNamesItsParameters) {
  for (const Effect& effect : all_effects()) {
    const fs::path path = kSource / "docs/effects" / (std::string(effect.name) + ".md");
    const std::string page = text_of(path);
    EXPECT_TRUE(page.starts_with("# " + std::string(effect.name) + "\n")) << path;
    for (const EffectParameter& p : effect.parameters)
      EXPECT_TRUE(says(page, "| `" + std::string(p.name) + "` | " + (*p.unit ? p.unit : "–") + " |"))
          << path << ": " << p.name << " [" << p.unit << "]";
    for (const char* part : {"## Holds for", "## In a mill", "## Source"})
      EXPECT_TRUE(says(page, part)) << path << ": " << part;
    EXPECT_TRUE(says(text_of(kSource / "docs/effects/README.md"), "](" + std::string(effect.name) + ".md)"))
        << effect.name << ": not in the index";
  }
}

}  // namespace
}  // namespace tumble
