#include "io/in_place_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "core/error.h"

namespace tumble::io {
namespace {

constexpr std::size_t kSmall = 4096;             // [bytes] from here on a call costs little beside the copying
constexpr std::size_t kMostTouched = 4'000'000;  // pages of the map would else count as the program's memory

}  // namespace

InPlaceFile::InPlaceFile(const std::filesystem::path& path, const std::filesystem::path& shown) : shown_(shown) {
  file_ = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file_ < 0) fail("cannot be opened", errno);
}
InPlaceFile::~InPlaceFile() {
  if (map_) munmap(map_, map_size_);
  if (file_ >= 0) close(file_);
}
InPlaceFile::InPlaceFile(InPlaceFile&& other) noexcept
    : file_(std::exchange(other.file_, -1)),
      shown_(std::move(other.shown_)),
      map_(std::exchange(other.map_, nullptr)),
      map_size_(other.map_size_),
      touched_(other.touched_) {}
InPlaceFile& InPlaceFile::operator=(InPlaceFile&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(shown_, other.shown_);
  std::swap(map_, other.map_);
  std::swap(map_size_, other.map_size_);
  std::swap(touched_, other.touched_);
  return *this;
}

// Where a small piece goes, if it goes through memory.
void* InPlaceFile::map_small(std::uint64_t offset, std::size_t size) const {
  if (!map_ || size > kSmall || offset + size > map_size_) return nullptr;
  if ((touched_ += size) > kMostTouched) {
    madvise(map_, map_size_, MADV_DONTNEED);  // what is in them stays the file's
    touched_ = 0;
  }
  return map_ + offset;
}

void InPlaceFile::write(std::uint64_t offset, const void* bytes, std::size_t size) const {
  if (void* place = map_small(offset, size)) {
    std::atomic_thread_fence(std::memory_order_release);  // not before what was written before
    std::memcpy(place, bytes, size);
    return;
  }
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = pwrite(file_, from, size, static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail("cannot be written", written < 0 ? errno : ENOSPC);
    from += written;
    offset += static_cast<std::uint64_t>(written);
    size -= static_cast<std::size_t>(written);
  }
}

void InPlaceFile::read(std::uint64_t offset, void* bytes, std::size_t size) const {
  char* to = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = pread(file_, to, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail("cannot be read", errno);
    if (got == 0) throw WorkError(shown_.string(), "is cut off");
    to += got;
    offset += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
}

void InPlaceFile::claim() const {
  if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw WorkError(shown_.string(), "is in use by another program; wait for it or choose another output");
  flock(file_, LOCK_SH | LOCK_NB);  // file systems without locks do without
}

void InPlaceFile::reserve() {
  const off_t size = lseek(file_, 0, SEEK_END);
  if (fallocate(file_, 0, 0, size) == 0) {
    // Only now: where the disk is full, a write to the map would be the program's end instead of an error.
    void* map = mmap(nullptr, static_cast<std::size_t>(size), PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
    if (map == MAP_FAILED) return;  // a file system that does not do this, or a limit on memory
    map_ = static_cast<char*>(map);
    map_size_ = static_cast<std::size_t>(size);
    return;
  }
  const int why = errno;  // a file system that cannot promise space takes what it has as it comes
  if (why == ENOSPC || why == EFBIG || why == EDQUOT)
    throw WorkError(shown_.string(), "needs " + std::to_string(size / 1'000'000 + 1) + " MB: " + std::strerror(why));
}

void InPlaceFile::wipe(std::uint64_t offset, std::uint64_t size) const {
  if (fallocate(file_, FALLOC_FL_PUNCH_HOLE | FALLOC_FL_KEEP_SIZE, static_cast<off_t>(offset),
                static_cast<off_t>(size)) == 0)
    return;
  const std::vector<char> zeros(std::size_t{1} << 20);
  for (std::uint64_t done = 0; done < size; done += zeros.size())
    write(offset + done, zeros.data(), std::min<std::uint64_t>(zeros.size(), size - done));
}

void InPlaceFile::sync() const {
  if (fsync(file_) != 0) fail("cannot be brought to the disk", errno);
}

void InPlaceFile::fail(const char* what, int why) const {
  throw WorkError(shown_.string(), std::string(what) + ": " + std::strerror(why));
}

}  // namespace tumble::io
