#include "io/motion_file.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "core/error.h"
#include "core/motion_quantities.h"
#include "core/version.h"
#include "io/hdf5.h"
#include "io/output.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

constexpr int kFormat = 1;  // grows when an older reader could not read the file
constexpr const char* kFormatPath = "motion_file_format";
constexpr std::size_t kMostRows = std::size_t{1} << 30;
constexpr int kMostCells = 1 << 13;  // of a field's edge

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// A column of a table whose rows are structs.
template <typename Row, typename T>
struct Column {
  const char* name;
  const char* unit;
  T Row::*of;
  bool later = false;  // files of earlier programs lack it
};

// One function says where everything lies; it is walked to write and to read, so the two cannot disagree.
// `io` is a Writer or a Reader, `m` the ChargeMotion.
template <typename Io, typename Motion>
void walk(Io& io, Motion& m) {
  io.choice("source", m.source,
            {MotionSource::kRunFile, MotionSource::kFilm, MotionSource::kStills, MotionSource::kTracks});
  io.choice("rotation", m.rotation, {Rotation::kUnknown, Rotation::kCounterClockwise, Rotation::kClockwise});
  io.text("origin", m.origin);
  io.lines("caveats", m.caveats);
  io.scalar("mill/lifter_count", "", m.lifter_count);
  io.later_scalar("mill/lifters_seen", "", m.lifters_seen);
  io.estimate("mill/shell_by_balls", "", m.shell_by_balls);
  io.scalar("mill/radius", "m", m.mill_radius);
  io.scalar("mill/tip_radius", "m", m.tip_radius);
  io.scalar("frames/count", "", m.frames);
  io.scalar("frames/per_second", "s-1", m.frames_per_second);
  io.later_scalar("frames/per_second_se", "s-1", m.frames_per_second_se);
  io.array("frames/duplicated", "", m.duplicated_frames);
  io.array("frames/dropped", "", m.dropped_frames);
  for (const MotionQuantity& q : kMotionQuantities) io.estimate(std::string("summary/") + q.name, q.unit, m.*q.of);

  io.scalar("camera/centre_u", "px", m.camera.centre_u_px);
  io.scalar("camera/centre_v", "px", m.camera.centre_v_px);
  io.scalar("camera/radius", "px", m.camera.radius_px);
  io.scalar("camera/metres_per_pixel", "m", m.camera.metres_per_pixel);
  io.later_scalar("camera/centre_u_se", "px", m.camera.centre_u_px_se);
  io.later_scalar("camera/centre_v_se", "px", m.camera.centre_v_px_se);
  io.later_scalar("camera/radius_se", "px", m.camera.radius_px_se);
  io.later_scalar("camera/metres_per_pixel_se", "m", m.camera.metres_per_pixel_se);
  io.estimate("camera/roll", "deg", m.camera.roll_deg);
  io.later_scalar("camera/k1", "", m.camera.k1.value);
  io.later_scalar("camera/k1_se", "", m.camera.k1.se);
  io.scalar("camera/width", "px", m.camera.width_px);
  io.scalar("camera/height", "px", m.camera.height_px);
  io.lens("camera/lens", m.camera.lens);

  io.fixed("ring/occupancy", "", m.ring_occupancy);
  io.later_fixed("ring/occupancy_se", "", m.ring_occupancy_se);
  io.table("profile", m.profile, Column{"frame", "", &ProfileRow::frame}, Column{"time", "s", &ProfileRow::time},
           Column{"mill_angle", "deg", &ProfileRow::mill_angle_deg}, Column{"toe", "deg", &ProfileRow::toe_deg},
           Column{"shoulder", "deg", &ProfileRow::shoulder_deg}, Column{"head", "m", &ProfileRow::head});
  io.table("tracks", m.tracks, Column{"frame", "", &TrackPoint::frame}, Column{"id", "", &TrackPoint::id},
           Column{"time", "s", &TrackPoint::time}, Column{"x", "m", &TrackPoint::x}, Column{"y", "m", &TrackPoint::y},
           Column{"vx", "m s-1", &TrackPoint::vx}, Column{"vy", "m s-1", &TrackPoint::vy},
           Column{"radius", "m", &TrackPoint::radius}, Column{"spin", "rad s-1", &TrackPoint::spin},
           Column{"u", "px", &TrackPoint::u_px}, Column{"v", "px", &TrackPoint::v_px},
           Column{"x_se", "m", &TrackPoint::x_se, true}, Column{"visible", "", &TrackPoint::visible, true},
           Column{"confidence", "", &TrackPoint::confidence, true});
  io.table("surface", m.surface, Column{"x", "m", &SurfacePoint::x, true}, Column{"y", "m", &SurfacePoint::y, true},
           Column{"se", "m", &SurfacePoint::se, true});
  io.table("torque", m.torque_series, Column{"time", "s", &TorqueRow::time},
           Column{"torque", "N m", &TorqueRow::torque}, Column{"power", "W", &TorqueRow::power});

  io.scalar("field/cell", "m", m.field.cell);
  io.scalar("field/cells", "", m.field.n);
  const int n = m.field.n;
  io.grid("field/occupancy", "", m.field.occupancy, n);
  io.grid("field/occupancy_se", "", m.field.occupancy_se, n);
  io.grid("field/vx", "m s-1", m.field.vx, n);
  io.grid("field/vy", "m s-1", m.field.vy, n);
  io.grid("field/vx_se", "m s-1", m.field.vx_se, n);
  io.grid("field/vy_se", "m s-1", m.field.vy_se, n);
  io.grid("field/temperature", "m2 s-2", m.field.temperature, n);
}

struct Writer {
  hid_t file;

  template <typename T>
  void scalar(const std::string& path, const char* unit, T value) {
    hdf5::write_scalar<T>(file, path, value, unit);
  }
  template <typename T>
  void later_scalar(const std::string& path, const char* unit, T value) {
    scalar(path, unit, value);
  }
  void estimate(const std::string& path, const char* unit, const Estimate& e) {
    scalar(path, unit, e.value);
    scalar(path + "_se", unit, e.se);
  }
  void text(const std::string& path, const std::string& value) { hdf5::make_string(file, path, value); }
  void lines(const std::string& path, const std::vector<std::string>& values) {
    std::string all;
    for (std::string line : values) {
      std::replace(line.begin(), line.end(), '\n', ' ');
      all += line + "\n";
    }
    text(path, all);
  }
  template <typename E>
  void choice(const std::string& path, E value, std::initializer_list<E>) {
    text(path, name_of(value));
  }
  template <typename T>
  void array(const std::string& path, const char* unit, const std::vector<T>& values) {
    hdf5::write_array<T>(file, path, values, {values.size()}, unit);
  }
  void fixed(const std::string& path, const char* unit, const std::array<double, 360>& values) {
    hdf5::write_array<double>(file, path, values, {values.size()}, unit);
  }
  void later_fixed(const std::string& path, const char* unit, const std::array<double, 360>& values) {
    fixed(path, unit, values);
  }
  void grid(const std::string& path, const char* unit, const std::vector<double>& values, int n) {
    const auto edge = static_cast<hsize_t>(values.empty() ? 0 : n);
    hdf5::write_array<double>(file, path, values, {edge, edge}, unit);
  }
  void lens(const std::string& path, const std::optional<MillCamera>& camera) {
    if (!camera) return;
    const RowMajor rotation = camera->rotation;
    hdf5::write_array<double>(file, path + "/pinhole",
                              std::array{camera->focal, camera->centre_u, camera->centre_v, camera->k1, camera->k2},
                              {5}, "");
    hdf5::write_array<double>(file, path + "/rotation", std::span(rotation.data(), 9), {3, 3}, "");
    hdf5::write_array<double>(file, path + "/translation", std::span(camera->translation.data(), 3), {3}, "");
  }
  template <typename Rows, typename Row, typename... T>
  void table(const std::string& path, const Rows& rows, const Column<Row, T>&... columns) {
    const auto write = [&](const auto& column) {
      using Value = std::decay_t<decltype(std::declval<Row>().*column.of)>;
      const std::string name = path + "/" + column.name;
      const auto set = hdf5::make_array(file, name, hdf5::native<Value>(), {rows.size()}, column.unit);
      std::vector<Value> values;
      each_block(rows, [&](std::size_t first, std::span<const Row> block) {
        values.clear();
        for (const Row& row : block) values.push_back(row.*column.of);
        hdf5::write_part<Value>(set, name, first, values);
      });
    };
    (write(columns), ...);
  }

 private:
  template <typename Row, typename Use>
  static void each_block(const std::vector<Row>& rows, const Use& use) {
    if (!rows.empty()) use(0, std::span<const Row>(rows));
  }
  template <typename Row, typename Use>
  static void each_block(const Spool<Row>& rows, const Use& use) {
    rows.each_block(use);
  }
};

struct Reader {
  hid_t file;

  template <typename T>
  void scalar(const std::string& path, const char*, T& value) const {
    value = hdf5::read_scalar<T>(file, path);
  }
  template <typename T>
  void later_scalar(const std::string& path, const char* unit, T& value) const {  // older files lack it
    if (hdf5::exists(file, path)) scalar(path, unit, value);
  }
  void estimate(const std::string& path, const char* unit, Estimate& e) const {
    if (!hdf5::exists(file, path)) return;  // quantities are added; files of earlier programs lack them
    scalar(path, unit, e.value);
    scalar(path + "_se", unit, e.se);
  }
  void text(const std::string& path, std::string& value) const { value = hdf5::read_string(file, path); }
  void lines(const std::string& path, std::vector<std::string>& values) const {
    std::istringstream all(hdf5::read_string(file, path));
    for (std::string line; std::getline(all, line);) values.push_back(line);
  }
  template <typename E>
  void choice(const std::string& path, E& value, std::initializer_list<E> known) const {
    const std::string name = hdf5::read_string(file, path);
    for (const E one : known)
      if (name == name_of(one)) {
        value = one;
        return;
      }
    throw hdf5::Failure(path + " is \"" + name.substr(0, 40) + "\", which this program does not know");
  }
  template <typename T>
  void array(const std::string& path, const char*, std::vector<T>& values) const {
    values = hdf5::read_array<T>(file, path, kMostRows);
  }
  void fixed(const std::string& path, const char*, std::array<double, 360>& values) const {
    const auto read = hdf5::read_array<double>(file, path, values.size());
    if (read.size() != values.size())
      throw hdf5::Failure(path + " has " + std::to_string(read.size()) + " bins, not 360");
    std::copy(read.begin(), read.end(), values.begin());
  }
  void later_fixed(const std::string& path, const char* unit, std::array<double, 360>& values) const {
    if (hdf5::exists(file, path)) fixed(path, unit, values);
  }
  void grid(const std::string& path, const char*, std::vector<double>& values, int n) const {
    if (n < 0 || n > kMostCells) throw hdf5::Failure("field/cells is out of range");
    const std::size_t cells = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
    values = hdf5::read_array<double>(file, path, cells);
    if (!values.empty() && values.size() != cells) throw hdf5::Failure(path + " does not fit field/cells");
  }
  void lens(const std::string& path, std::optional<MillCamera>& camera) const {
    if (!hdf5::exists(file, path)) return;
    const auto numbers = [&](const char* name, std::size_t count) {
      auto values = hdf5::read_array<double>(file, path + "/" + name, count);
      if (values.size() != count) throw hdf5::Failure(path + "/" + name + " has another size than a camera's");
      return values;
    };
    const auto pinhole = numbers("pinhole", 5), rotation = numbers("rotation", 9);
    const auto translation = numbers("translation", 3);
    camera = MillCamera{pinhole[0], pinhole[1], pinhole[2], pinhole[3], pinhole[4]};
    camera->rotation = Eigen::Map<const RowMajor>(rotation.data());
    camera->translation = Eigen::Map<const Eigen::Vector3d>(translation.data());
  }
  template <typename Rows, typename Row, typename... T>
  void table(const std::string& path, Rows& rows, const Column<Row, T>&... columns) const {
    std::size_t count = 0;
    bool first = true;
    const auto look = [&](const auto& column) {
      const std::string name = path + "/" + column.name;
      if (column.later && !hdf5::exists(file, name)) return;
      const std::size_t here = hdf5::count_of(hdf5::open_array(file, name), name, kMostRows);
      if (std::exchange(first, false)) count = here;
      if (here != count) throw hdf5::Failure(name + " has another length than its neighbours");
    };
    (look(columns), ...);
    constexpr std::size_t kBlock = 65'536;
    std::vector<Row> block;
    for (std::size_t from = 0; from < count; from += kBlock) {
      block.assign(std::min(kBlock, count - from), {});
      const auto read = [&](const auto& column) {
        using Value = std::decay_t<decltype(std::declval<Row>().*column.of)>;
        const std::string name = path + "/" + column.name;
        if (column.later && !hdf5::exists(file, name)) return;
        const auto values = hdf5::read_part<Value>(hdf5::open_array(file, name), name, from, block.size());
        for (std::size_t i = 0; i < block.size(); ++i) block[i].*column.of = values[i];
      };
      (read(columns), ...);
      append(rows, std::span<const Row>(block));
    }
  }

 private:
  template <typename Row>
  static void append(std::vector<Row>& rows, std::span<const Row> block) {
    rows.insert(rows.end(), block.begin(), block.end());
  }
  template <typename Row>
  static void append(Spool<Row>& rows, std::span<const Row> block) {
    rows.append(block);
  }
};

}  // namespace

void write_motion(const fs::path& path, const ChargeMotion& motion) {
  StagedFile staged(path);
  try {
    const auto held = hdf5::lock();
    auto file = hdf5::create_file(staged.path());
    hdf5::write_scalar<int>(file, kFormatPath, kFormat);
    hdf5::set_attribute(file, "version", kVersion);
    Writer writer{file};
    walk(writer, motion);
    hdf5::close_file(std::move(file));
  } catch (const hdf5::Failure& e) {
    throw WorkError(path.string(), e.what());
  }
  staged.commit();
}

ChargeMotion read_motion(const fs::path& path) {
  const auto held = hdf5::lock();
  const auto file = hdf5::open_input(path, "a motion file");
  if (!hdf5::exists(file, kFormatPath))
    throw InputError(path.string(), "is an HDF5 file but no motion file; give what analyse has written");
  try {
    const int format = hdf5::read_scalar<int>(file, kFormatPath);
    if (format != kFormat)
      throw hdf5::Failure("its format is " + std::to_string(format) + ", this program reads " +
                          std::to_string(kFormat));
    ChargeMotion motion;
    Reader reader{file};
    walk(reader, motion);
    return motion;
  } catch (const hdf5::Failure& e) {
    throw InputError(path.string(), std::string("is not a whole motion file: ") + e.what());
  } catch (const std::bad_alloc&) {
    throw InputError(path.string(), "is too large for this machine's memory");
  }
}

bool is_motion_file(const fs::path& path) {
  if (!hdf5::is_hdf5(path)) return false;
  const auto held = hdf5::lock();
  try {
    return hdf5::exists(hdf5::open_file(path, hdf5::Access::kRead), kFormatPath);
  } catch (const hdf5::Failure&) {
    return false;
  }
}

}  // namespace tumble::io
