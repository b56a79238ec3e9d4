#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace tumble::io {

// A file that is there and is changed in place. What fails throws WorkError with the path and the system's reason.
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
  // Asks for all of the disk space now: better than to fail after hours.
  void reserve() const;
  // Gives the bytes back to the disk; they read as zeros.
  void wipe(std::uint64_t offset, std::uint64_t size) const;
  void sync() const;

 private:
  [[noreturn]] void fail(const char* what, int why) const;
  int file_ = -1;
  std::filesystem::path shown_;
};

}  // namespace tumble::io
