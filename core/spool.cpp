#include "core/spool.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include "core/error.h"

namespace tumble {
namespace {

constexpr std::size_t kInMemory = std::size_t{8} << 20;  // [bytes]

[[noreturn]] void fail(const std::string& what) {
  throw WorkError("temporary file in " + std::filesystem::temp_directory_path().string(),
                  what + ": " + std::strerror(errno) + "; TMPDIR names another folder");
}

int unnamed_file() {
  std::string name = (std::filesystem::temp_directory_path() / "tumble-XXXXXX").string();
  const int file = mkstemp(name.data());
  if (file < 0) fail("cannot be made");
  unlink(name.c_str());
  return file;
}

void write_all(int file, std::size_t from, const void* bytes, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const ssize_t n =
        pwrite(file, static_cast<const char*>(bytes) + done, count - done, static_cast<off_t>(from + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail("cannot be written");
    done += static_cast<std::size_t>(n);
  }
}

}  // namespace

ByteSpool::~ByteSpool() {
  if (file_ >= 0) close(file_);
}

void ByteSpool::append(const void* bytes, std::size_t count) {
  if (count == 0) return;
  if (file_ < 0 && size_ + count > kInMemory) {
    file_ = unnamed_file();
    write_all(file_, 0, memory_.data(), memory_.size());
    memory_ = {};
  }
  if (file_ >= 0) {
    write_all(file_, size_, bytes, count);
  } else {
    const auto* first = static_cast<const std::byte*>(bytes);
    memory_.insert(memory_.end(), first, first + count);
  }
  size_ += count;
}

void ByteSpool::read(std::size_t from, void* bytes, std::size_t count) const {
  if (count == 0) return;
  if (file_ < 0) {
    std::memcpy(bytes, memory_.data() + from, count);
    return;
  }
  for (std::size_t done = 0; done < count;) {
    const ssize_t n = pread(file_, static_cast<char*>(bytes) + done, count - done, static_cast<off_t>(from + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail("cannot be read");
    done += static_cast<std::size_t>(n);
  }
}

void ByteSpool::write(std::size_t from, const void* bytes, std::size_t count) {
  if (count == 0) return;
  if (file_ < 0)
    std::memcpy(memory_.data() + from, bytes, count);
  else
    write_all(file_, from, bytes, count);
}

}  // namespace tumble
