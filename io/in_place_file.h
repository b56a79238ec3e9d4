#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace tumble::io {

// A file that is there and is changed in place, in the order of the calls. What fails throws WorkError with the path
// and the system's reason.
class InPlaceFile {
 public:
  InPlaceFile() = default;
  // `shown`: the name in messages.
  InPlaceFile(const std::filesystem::path& path, const std::filesystem::path& shown);
  ~InPlaceFile();
  InPlaceFile(InPlaceFile&& other) noexcept;
  InPlaceFile& operator=(InPlaceFile&& other) noexcept;

  void write(std::uint64_t offset, const void* bytes, std::size_t size) const;
  void read(std::uint64_t offset, void* bytes, std::size_t size) const;

  // One writer at a time. A shared lock is kept, so that HDF5 programs may look at the run while it goes on.
  void claim() const;
  // Asks for all of the disk space now: better than to fail after hours. Where the disk promises it, small pieces go
  // through memory that is the file's from then on: a call for each would cost a small mill a tenth of its time. The
  // system has them at once all the same, so that the program's death loses none.
  void reserve();
  // Gives the bytes back to the disk; they read as zeros.
  void wipe(std::uint64_t offset, std::uint64_t size) const;
  void sync() const;

 private:
  [[noreturn]] void fail(const char* what, int why) const;
  void* map_small(std::uint64_t offset, std::size_t size) const;
  int file_ = -1;
  std::filesystem::path shown_;
  char* map_ = nullptr;
  std::size_t map_size_ = 0;
  mutable std::size_t touched_ = 0;  // [bytes] of the map, since its pages were last given back
};

}  // namespace tumble::io
