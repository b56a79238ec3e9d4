#pragma once
#include "core/config.h"

namespace tumble {

// Parts of check() and check_complete() (core/config.h): ranges of mill.lifters, and whether the profile, worn or new,
// is a body that can stand on the shell. Expect effects that are checked.
void check_lifters(const Config& config);
void check_lifters_complete(const Config& config);

}  // namespace tumble
