#include "io/chunk_store.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/fingerprint.h"
#include "io/hdf5.h"
#include "io/output.h"
#include "io/text_file.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {
constexpr std::size_t kLargestMiB = 4;
}

ChunkStore::ChunkStore(const fs::path& root, const std::string& definition)
    : folder_(root / fmt::format("{:016x}", fingerprint(definition))) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw InputError(folder_.string(), "cannot be made: " + error.message());
  make_output_folder(folder_);
  const fs::path said = folder_ / "definition.txt";
  if (!fs::exists(said, error)) {
    write_text(said, definition);
  } else if (read_text(said, "a library's definition", kLargestMiB) != definition) {
    throw InputError(said.string(), "is of another library than its folder's name says; remove the folder");
  }
}

fs::path ChunkStore::file_of(std::size_t chunk) const { return folder_ / fmt::format("{:05}.h5", chunk); }

bool ChunkStore::has(std::size_t chunk) const {
  std::error_code error;
  return fs::exists(file_of(chunk), error);
}

bool ChunkStore::read(std::size_t chunk, Rows& rows) const {
  const fs::path path = file_of(chunk);
  if (!has(chunk)) return false;
  const auto held = hdf5::lock();
  try {
    const hdf5::File file = hdf5::open_file(path, hdf5::Access::kRead);
    const auto lengths = hdf5::read_array<int>(file, "lengths");
    const auto numbers = hdf5::read_array<float>(file, "numbers");
    rows.clear();
    auto at = numbers.begin();
    for (const int length : lengths) {
      if (length < 0 || numbers.end() - at < length) return false;
      rows.emplace_back(at, at + length);
      at += length;
    }
    return at == numbers.end();
  } catch (const hdf5::Failure&) {
    return false;
  }
}

void ChunkStore::write(std::size_t chunk, const Rows& rows) const {
  std::vector<int> lengths;
  std::vector<float> numbers;
  for (const auto& row : rows) {
    lengths.push_back(static_cast<int>(row.size()));
    numbers.insert(numbers.end(), row.begin(), row.end());
  }
  const auto held = hdf5::lock();
  try {
    StagedFile staged(file_of(chunk));
    hdf5::File file = hdf5::create_file(staged.path());
    hdf5::write_array<int>(file, "lengths", lengths, {lengths.size()});
    hdf5::write_array<float>(file, "numbers", numbers, {numbers.size()});
    hdf5::close_file(std::move(file));
    staged.commit();
  } catch (const hdf5::Failure& e) {
    throw WorkError(file_of(chunk).string(), e.what());
  }
}

}  // namespace tumble::io
