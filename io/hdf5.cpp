#include "io/hdf5.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/error.h"

namespace tumble::io::hdf5 {
namespace {

constexpr std::size_t kLongestString = 1 << 20;  // [bytes]

// The library's own words for what the system said, from the depth of its error stack.
herr_t look_for_reason(unsigned, const H5E_error2_t* entry, void* found) {
  const std::string text = entry->desc ? entry->desc : "";
  const std::string mark = "error message = '";
  if (const auto at = text.find(mark); at != std::string::npos) {
    const auto begin = at + mark.size();
    *static_cast<std::string*>(found) = text.substr(begin, text.find('\'', begin) - begin);
  }
  return 0;
}

Properties properties(hid_t kind) { return Properties(checked(H5Pcreate(kind), "make a property list")); }

Properties file_access() {
  Properties access = properties(H5P_FILE_ACCESS);
  // The library's own lock would let a program that only watches a run stop its end.
  checked(H5Pset_file_locking(access, false, true), "do without file locks");
  // The format of HDF5 1.8: unlike the oldest it has checksums over what describes the file, so damage is noticed
  // before the library trusts it; unlike the newest it has no flag "open for writing" that a killed writer leaves.
  checked(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18), "choose the format");
  return access;
}

Type string_type(std::size_t size) {
  Type type(checked(H5Tcopy(H5T_C_S1), "make a string type"));
  checked(H5Tset_size(type, size), "size a string type");
  checked(H5Tset_cset(type, H5T_CSET_UTF8), "name a string's encoding");
  checked(H5Tset_strpad(type, H5T_STR_NULLPAD), "pad a string type");
  return type;
}

Properties dataset_creation(Fill fill) {
  Properties creation = properties(H5P_DATASET_CREATE);
  checked(H5Pset_obj_track_times(creation, false), "leave out times");
  checked(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY), "fix a dataset's place");
  checked(H5Pset_fill_time(creation, fill == Fill::kNone ? H5D_FILL_TIME_NEVER : H5D_FILL_TIME_ALLOC), "set filling");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::int64_t minus_one = -1;
  if (fill == Fill::kNan) checked(H5Pset_fill_value(creation, H5T_NATIVE_DOUBLE, &nan), "set a fill value");
  if (fill == Fill::kMinusOne) checked(H5Pset_fill_value(creation, H5T_NATIVE_INT64, &minus_one), "set a fill value");
  return creation;
}

Space make_space(const Shape& shape) {
  return Space(checked(
      shape.empty() ? H5Screate(H5S_SCALAR) : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      "make a shape"));
}

}  // namespace

std::unique_lock<std::recursive_mutex> lock() {
  static std::recursive_mutex mutex;
  std::unique_lock held(mutex);
  // At exit the library would close files that a full disk let it neither write nor close, and crash over them.
  [[maybe_unused]] static const herr_t before_first_use = H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are ours to tell
  return held;
}

hid_t checked(hid_t returned, const std::string& attempt) {
  if (returned >= 0) return returned;
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, look_for_reason, &reason);
  throw Failure("cannot " + attempt + (reason.empty() ? "" : " (" + reason + ")"));
}

File create_file(const std::filesystem::path& path) {
  Properties creation = properties(H5P_FILE_CREATE);
  checked(H5Pset_obj_track_times(creation, false), "leave out times");
  return File(checked(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, file_access()), "create the file"));
}

File open_file(const std::filesystem::path& path, Access access) {
  return File(checked(H5Fopen(path.c_str(), access == Access::kRead ? H5F_ACC_RDONLY : H5F_ACC_RDWR, file_access()),
                      "open the file"));
}

bool is_hdf5(const std::filesystem::path& path) {
  const auto held = lock();
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) && H5Fis_hdf5(path.c_str()) > 0;
}

File open_input(const std::filesystem::path& path, const std::string& wanted) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) throw InputError(path.string(), "is a folder; give " + wanted);
  if (!std::filesystem::exists(status)) {
    const std::string part = path.string() + ".part";
    throw InputError(path.string(),
                     "no such file; " + (std::filesystem::exists(part, error) ? "an interrupted one is there as " + part
                                                                              : "give " + wanted));
  }
  if (!std::filesystem::is_regular_file(status)) throw InputError(path.string(), "is not a file; give " + wanted);
  errno = 0;
  if (!std::ifstream(path)) throw InputError(path.string(), std::string("cannot be read: ") + std::strerror(errno));
  if (!is_hdf5(path)) throw InputError(path.string(), "is not an HDF5 file; give " + wanted);
  try {
    return open_file(path, Access::kRead);
  } catch (const Failure&) {
    throw InputError(path.string(), "is an HDF5 file that is cut off or damaged; give " + wanted + " that is whole");
  }
}

void close_file(File file) { checked(H5Fflush(file, H5F_SCOPE_LOCAL), "write the file"); }

Group make_group(hid_t parent, const std::string& path) {
  if (exists(parent, path)) return Group(checked(H5Gopen2(parent, path.c_str(), H5P_DEFAULT), "open group " + path));
  // Step by step: groups that the library makes on the way record the time.
  if (const auto slash = path.rfind('/'); slash != std::string::npos) make_group(parent, path.substr(0, slash));
  Properties creation = properties(H5P_GROUP_CREATE);
  checked(H5Pset_obj_track_times(creation, false), "leave out times");
  return Group(checked(H5Gcreate2(parent, path.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), "make " + path));
}

bool exists(hid_t parent, const std::string& path) {
  // H5Lexists asks for one step at a time.
  for (std::size_t slash = path.find('/'); slash != std::string::npos; slash = path.find('/', slash + 1))
    if (H5Lexists(parent, path.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  return H5Lexists(parent, path.c_str(), H5P_DEFAULT) > 0;
}

Dataset make_array(hid_t parent, const std::string& path, hid_t type, const Shape& shape, const std::string& unit,
                   Fill fill) {
  if (const auto slash = path.rfind('/'); slash != std::string::npos) make_group(parent, path.substr(0, slash));
  Dataset set(checked(
      H5Dcreate2(parent, path.c_str(), type, make_space(shape), H5P_DEFAULT, dataset_creation(fill), H5P_DEFAULT),
      "make " + path));
  if (!unit.empty()) set_attribute(set, "unit", unit);
  return set;
}

void make_string(hid_t parent, const std::string& path, const std::string& text, std::size_t capacity) {
  const std::size_t size = std::max<std::size_t>({capacity, text.size(), 1});
  const Type type = string_type(size);
  const Dataset set = make_array(parent, path, type, {});
  std::string padded = text;
  padded.resize(size, '\0');
  checked(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, padded.data()), "write " + path);
}

void set_attribute(hid_t object, const char* name, const std::string& text) {
  const Type type = string_type(std::max<std::size_t>(text.size(), 1));
  const Attribute attribute(
      checked(H5Acreate2(object, name, type, make_space({}), H5P_DEFAULT, H5P_DEFAULT), std::string("make ") + name));
  checked(H5Awrite(attribute, type, text.c_str()), std::string("write ") + name);
}

void set_attribute(hid_t object, const char* name, const std::vector<int>& numbers) {
  const Shape shape = numbers.size() == 1 ? Shape{} : Shape{numbers.size()};
  const Attribute attribute(
      checked(H5Acreate2(object, name, H5T_NATIVE_INT, make_space(shape), H5P_DEFAULT, H5P_DEFAULT),
              std::string("make ") + name));
  checked(H5Awrite(attribute, H5T_NATIVE_INT, numbers.data()), std::string("write ") + name);
}

Dataset open_array(hid_t parent, const std::string& path) {
  return Dataset(checked(H5Dopen2(parent, path.c_str(), H5P_DEFAULT), "find " + path));
}

Shape shape_of(hid_t dataset, const std::string& path) {
  const Space space(checked(H5Dget_space(dataset), "read the shape of " + path));
  const int rank = static_cast<int>(checked(H5Sget_simple_extent_ndims(space), "read the shape of " + path));
  Shape shape(static_cast<std::size_t>(rank));
  checked(H5Sget_simple_extent_dims(space, shape.data(), nullptr), "read the shape of " + path);
  return shape;
}

std::uint64_t place_of(hid_t dataset, const std::string& path) {
  const haddr_t place = H5Dget_offset(dataset);
  if (place == HADDR_UNDEF) throw Failure(path + " is not in one piece");
  return place;
}

std::size_t count_of(hid_t dataset, const std::string& path, std::size_t most) {
  std::size_t count = 1;
  for (const hsize_t n : shape_of(dataset, path)) {
    if (n != 0 && count > most / n) throw Failure(path + " holds more than can be right");
    count *= n;
  }
  return count;
}

std::string read_string(hid_t parent, const std::string& path) {
  const Dataset set = open_array(parent, path);
  const Type type(checked(H5Dget_type(set), "read the type of " + path));
  const std::size_t size = H5Tget_size(type);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0 || size == 0 || size > kLongestString ||
      count_of(set, path, 1) != 1)
    throw Failure(path + " is not a text of fixed length");
  std::string text(size, '\0');
  checked(H5Dread(set, string_type(size), H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "read " + path);
  return text.substr(0, text.find('\0'));
}

std::vector<int> read_attribute(hid_t object, const char* name) {
  const Attribute attribute(checked(H5Aopen(object, name, H5P_DEFAULT), std::string("find attribute ") + name));
  const Space space(checked(H5Aget_space(attribute), std::string("read attribute ") + name));
  const hssize_t count = H5Sget_simple_extent_npoints(space);
  if (count < 1 || count > 16) throw Failure(std::string("attribute ") + name + " has another shape");
  std::vector<int> numbers(static_cast<std::size_t>(count));
  checked(H5Aread(attribute, H5T_NATIVE_INT, numbers.data()), std::string("read attribute ") + name);
  return numbers;
}

Part part_of(hid_t dataset, const std::string& path, std::size_t first, std::size_t count) {
  Part part{Space(checked(H5Dget_space(dataset), "read " + path)), Space()};
  const hsize_t start = first, length = count;
  checked(H5Sselect_hyperslab(part.file, H5S_SELECT_SET, &start, nullptr, &length, nullptr), "read a part of " + path);
  part.memory = Space(checked(H5Screate_simple(1, &length, nullptr), "read a part of " + path));
  return part;
}

}  // namespace tumble::io::hdf5
