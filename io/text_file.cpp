#include "io/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "core/error.h"

namespace tumble::io {
namespace fs = std::filesystem;

std::string read_text(const fs::path& path, const std::string& wanted, std::size_t most_mib) {
  std::error_code error;
  const auto status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) throw InputError(path.string(), "no such file; give " + wanted);
  if (error) throw InputError(path.string(), "cannot be read: " + error.message() + "; give " + wanted);
  if (fs::is_directory(status)) throw InputError(path.string(), "is a folder; give " + wanted);
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  // Read, not asked for its size: a pipe has none.
  while (file && text.size() <= most_mib << 20) {
    const std::size_t had = text.size();
    text.resize(had + (1 << 20));
    file.read(text.data() + had, 1 << 20);
    text.resize(had + static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad() || (!file && !file.eof()))
    throw InputError(path.string(),
                     fmt::format("cannot be read: {}; give {}", std::strerror(errno ? errno : EIO), wanted));
  if (text.size() > most_mib << 20)
    throw InputError(path.string(),
                     fmt::format("is larger than {} MiB, so hardly what it should be; give {}", most_mib, wanted));
  return text;
}

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return line.size() > 300 ? line.substr(0, 300) + " ..." : line;
}

}  // namespace tumble::io
