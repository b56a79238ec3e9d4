#pragma once
#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

// The only door to the HDF5 library: handles that close themselves, and arrays and strings in one call. A failing call
// throws Failure with what was attempted; the file formats turn it into an InputError or WorkError with the path.
namespace tumble::io::hdf5 {

class Failure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The library keeps global state and Debian's build has no lock: whoever uses it holds this for the while.
std::unique_lock<std::recursive_mutex> lock();

template <herr_t (*Close)(hid_t)>
class Handle {
 public:
  explicit Handle(hid_t id = -1) : id_(id) {}
  ~Handle() {
    if (id_ >= 0) Close(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  operator hid_t() const { return id_; }  // NOLINT: made to be passed to the C functions

 private:
  hid_t id_;
};
using File = Handle<H5Fclose>;
using Group = Handle<H5Gclose>;
using Dataset = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using Attribute = Handle<H5Aclose>;
using Properties = Handle<H5Pclose>;

// Throws Failure("cannot <attempt> (<system's reason>)") where a call returned a negative number.
hid_t checked(hid_t returned, const std::string& attempt);

enum class Access { kRead, kChange };
File create_file(const std::filesystem::path& path);
File open_file(const std::filesystem::path& path, Access access);
// For files that a user names: throws InputError where `path` is not there, a folder, not HDF5, or cut off. `wanted`
// says what would be right: "a run file".
File open_input(const std::filesystem::path& path, const std::string& wanted);
bool is_hdf5(const std::filesystem::path& path);
// Writes what the library still holds, and says so where that fails (a destructor cannot).
void close_file(File file);

// Groups on the way are made; existing ones are fine.
Group make_group(hid_t parent, const std::string& path);
bool exists(hid_t parent, const std::string& path);

// `path` may name groups on the way, which are made. No times are recorded: same data, same bytes.
using Shape = std::vector<hsize_t>;
enum class Fill { kNone, kNan, kMinusOne };  // none: what was never written reads as 0, and costs no writing
// A dataset in one piece, its place in the file fixed at once.
Dataset make_array(hid_t parent, const std::string& path, hid_t type, const Shape& shape, const std::string& unit = {},
                   Fill fill = Fill::kNone);
void make_string(hid_t parent, const std::string& path, const std::string& text, std::size_t capacity = 0);
void set_attribute(hid_t object, const char* name, const std::string& text);
void set_attribute(hid_t object, const char* name, const std::vector<int>& numbers);

template <typename T>
hid_t native() {
  if constexpr (std::is_same_v<T, double>)
    return H5T_NATIVE_DOUBLE;
  else if constexpr (std::is_same_v<T, float>)
    return H5T_NATIVE_FLOAT;
  else if constexpr (std::is_same_v<T, std::int64_t>)
    return H5T_NATIVE_INT64;
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return H5T_NATIVE_UINT64;
  else {
    static_assert(std::is_same_v<T, int>, "a kind of number that no file holds");
    return H5T_NATIVE_INT;
  }
}

template <typename T>
void write_array(hid_t parent, const std::string& path, std::span<const T> values, const Shape& shape,
                 const std::string& unit = {}) {
  const Dataset set = make_array(parent, path, native<T>(), shape, unit);
  if (!values.empty())
    checked(H5Dwrite(set, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "write " + path);
}
template <typename T>
void write_scalar(hid_t parent, const std::string& path, T value, const std::string& unit = {}) {
  write_array<T>(parent, path, std::span<const T>(&value, 1), {}, unit);
}

Dataset open_array(hid_t parent, const std::string& path);
Shape shape_of(hid_t dataset, const std::string& path);
// Where a dataset in one piece begins in the file [bytes].
std::uint64_t place_of(hid_t dataset, const std::string& path);

// Throws Failure where there is no such dataset, its kind is another, or it holds more than `most` values.
inline constexpr std::size_t kMostValues = std::size_t{1} << 32;
std::size_t count_of(hid_t dataset, const std::string& path, std::size_t most = kMostValues);
template <typename T>
std::vector<T> read_array(hid_t parent, const std::string& path, std::size_t most = kMostValues) {
  const Dataset set = open_array(parent, path);
  std::vector<T> values(count_of(set, path, most));
  if (!values.empty()) checked(H5Dread(set, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read " + path);
  return values;
}
// Rows [first, first + count) of an array of one dimension.
struct Part {
  Space file, memory;
};
Part part_of(hid_t dataset, const std::string& path, std::size_t first, std::size_t count);
template <typename T>
void write_part(hid_t dataset, const std::string& path, std::size_t first, std::span<const T> values) {
  const Part part = part_of(dataset, path, first, values.size());
  checked(H5Dwrite(dataset, native<T>(), part.memory, part.file, H5P_DEFAULT, values.data()), "write " + path);
}
template <typename T>
std::vector<T> read_part(hid_t dataset, const std::string& path, std::size_t first, std::size_t count) {
  const Part part = part_of(dataset, path, first, count);
  std::vector<T> values(count);
  checked(H5Dread(dataset, native<T>(), part.memory, part.file, H5P_DEFAULT, values.data()), "read " + path);
  return values;
}
template <typename T>
T read_scalar(hid_t parent, const std::string& path) {
  const auto values = read_array<T>(parent, path, 1);
  if (values.empty()) throw Failure(path + " is empty");
  return values.front();
}
std::string read_string(hid_t parent, const std::string& path);
std::vector<int> read_attribute(hid_t object, const char* name);

}  // namespace tumble::io::hdf5
