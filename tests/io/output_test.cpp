#include "io/output.h"

#include <sys/stat.h>

#include "core/error.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using Output = InFolder;

TEST_F(Output, ReplacesAFileOnlyByForce) {
  const auto path = folder_ / "run.h5";
  EXPECT_NO_THROW(check_output_file(path, false));
  write_bytes(path, "old");
  EXPECT_THROW(check_output_file(path, false), InputError);
  EXPECT_NO_THROW(check_output_file(path, true));
}

// A rename over /dev/null would take it from the whole machine; a pipe stands in for it here.
TEST_F(Output, NeverReplacesADeviceOrPipe) {
  const auto pipe = folder_ / "pipe", link = folder_ / "link";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::filesystem::create_symlink(pipe, link);
  for (const auto& path : {pipe, link})
    for (const bool force : {false, true}) EXPECT_THROW(check_output_file(path, force), InputError);
}

TEST_F(Output, IsNotTheInput) {
  const auto run = folder_ / "run.h5", link = folder_ / "link.h5";
  write_bytes(run, "frames");
  std::filesystem::create_symlink(run, link);
  EXPECT_THROW(check_not_input(run, link), InputError);
  EXPECT_NO_THROW(check_not_input(folder_ / "motion.h5", run));
}

TEST_F(Output, NeedsANameAndAFolder) {
  EXPECT_THROW(check_output_file("", true), InputError);
  EXPECT_THROW(check_output_file(folder_, true), InputError);
  EXPECT_THROW(check_output_file(folder_ / "missing" / "run.h5", true), InputError);
  EXPECT_THROW(make_output_folder(""), InputError);
}

}  // namespace
}  // namespace tumble::io
