#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble::io {

// Rows of numbers in a folder of their own, a file for each chunk of rows. A chunk is there whole or not at all: many
// processes may add to one folder, and whatever kills them costs the chunks they were at.
class ChunkStore {
 public:
  using Rows = std::vector<std::vector<float>>;  // an empty row: there is none, and there never will be

  // Opens or makes root/NAME, NAME by the definition, which is written beside the chunks. Throws InputError where the
  // folder cannot be used.
  ChunkStore(const std::filesystem::path& root, const std::string& definition);

  bool has(std::size_t chunk) const;  // is there a file?
  // False where the chunk is not there, or is not what was written.
  bool read(std::size_t chunk, Rows& rows) const;
  void write(std::size_t chunk, const Rows& rows) const;  // throws WorkError

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path file_of(std::size_t chunk) const;
  std::filesystem::path folder_;
};

}  // namespace tumble::io
