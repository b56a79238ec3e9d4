#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace tumble::io {

// The whole of a text file that the user names; `wanted` is what it should be: "a MILL.toml". Throws InputError where
// it is not there, a folder, cannot be read, or is larger than `most_mib` (a film given by mistake is not to fill the
// memory).
std::string read_text(const std::filesystem::path& path, const std::string& wanted, std::size_t most_mib);

// A text of unknown origin as part of a message: control characters as spaces, cut after 300 bytes.
std::string one_line(std::string_view text);

}  // namespace tumble::io
