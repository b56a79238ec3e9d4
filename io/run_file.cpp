#include "io/run_file.h"

#include <algorithm>
#include <sstream>

#include "core/error.h"
#include "io/config_file.h"
#include "io/hdf5.h"
#include "io/run_layout.h"

namespace tumble::io {
namespace fs = std::filesystem;
using namespace run_layout;
namespace {

constexpr std::size_t kMostFrames = 1 << 28, kMostBalls = 1 << 26;  // more is a damaged file, not a run

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

bool holds_run(hid_t file) {
  return hdf5::exists(file, "h5md") && hdf5::exists(file, "particles/balls/position/value");
}

}  // namespace

// What is one number per frame is read at once; balls are read frame by frame.
struct RunReader::Impl {
  fs::path path;
  hdf5::File file;
  RunSetup setup;
  RunResult result;
  bool complete = false;
  std::string version;
  std::size_t frames = 0;
  std::vector<std::int64_t> step;
  std::vector<double> time;
  std::vector<std::vector<double>> series, dissipation;
  std::vector<hdf5::Dataset> balls;

  void read() {
    const auto format = hdf5::read_scalar<int>(file, kFormatPath);
    if (format != kFormat)
      throw hdf5::Failure("its format is " + std::to_string(format) + ", this program reads " +
                          std::to_string(kFormat));
    version = hdf5::read_string(file, "parameters/version");
    setup.config = parse_config(hdf5::read_string(file, "parameters/config"), path.string());
    setup.balls.radius = hdf5::read_array<double>(file, "particles/balls/radius", kMostBalls);
    setup.balls.mass = hdf5::read_array<double>(file, "particles/balls/mass", kMostBalls);
    setup.time_step = hdf5::read_scalar<double>(file, "parameters/time_step");
    setup.mill_speed = hdf5::read_scalar<double>(file, "parameters/mill_speed");
    setup.dissipation_causes = lines_of(hdf5::read_string(file, "parameters/dissipation_causes"));
    if (setup.balls.mass.size() != setup.balls.radius.size()) throw hdf5::Failure("radius and mass differ in length");

    time = hdf5::read_array<double>(file, kTime, kMostFrames);
    step = hdf5::read_array<std::int64_t>(file, kStep, kMostFrames);
    setup.frame_count = static_cast<std::int64_t>(time.size());
    const auto written = hdf5::read_scalar<std::int64_t>(file, kFramesWritten);
    if (written < 0 || written > setup.frame_count || step.size() != time.size())
      throw hdf5::Failure("its number of frames contradicts itself");
    frames = static_cast<std::size_t>(written);
    time.resize(frames);
    for (const Series& s : all_series()) series.push_back(read_series(s.path));
    for (const auto& cause : setup.dissipation_causes) dissipation.push_back(read_series(dissipation_path(cause)));
    for (const BallArray& b : all_ball_arrays()) open_balls(b);

    complete = hdf5::read_scalar<std::int64_t>(file, kComplete) == 1;
    if (complete) read_result();
  }

  std::vector<double> read_series(const std::string& path_in_file) const {
    auto values = hdf5::read_array<double>(file, path_in_file + "/value", kMostFrames);
    if (values.size() < frames) throw hdf5::Failure(path_in_file + " is shorter than the run");
    values.resize(frames);
    return values;
  }

  void open_balls(const BallArray& array) {
    const std::string name = std::string(array.path) + "/value";
    balls.push_back(hdf5::open_array(file, name));
    hdf5::Shape wanted{static_cast<hsize_t>(setup.frame_count), setup.balls.size()};
    if (array.second) wanted.push_back(2);
    if (hdf5::shape_of(balls.back(), name) != wanted) throw hdf5::Failure(name + " has another shape than the run");
  }

  void read_result() {
    result.spin_up_revolutions = hdf5::read_scalar<double>(file, "parameters/spin_up_revolutions");
    result.steady = hdf5::read_scalar<std::int64_t>(file, "parameters/steady") != 0;
    result.caveat = hdf5::read_string(file, "parameters/caveat");
    for (const ResultArray& array : all_result_arrays())
      array.of(result) = hdf5::read_array<double>(file, array.path, space_for(array, setup.config));
  }

  Frame without_balls(std::size_t index) const {
    if (index >= frames)
      throw InputError(path.string(), "has no frame " + std::to_string(index) + ", its frames are 0 to " +
                                          std::to_string(frames) + " - 1");
    Frame frame;
    frame.step = step[index];
    frame.time = time[index];
    for (std::size_t i = 0; i < series.size(); ++i) all_series()[i].of(frame) = series[i][index];
    for (const auto& values : dissipation) frame.observed.dissipation.push_back(values[index]);
    return frame;
  }

  void read_balls(std::size_t index, const BallArray& array, hid_t set, Frame& frame) const {
    const hsize_t n = setup.balls.size(), parts = array.components();
    std::vector<double> row(n * parts);
    const hsize_t start[3] = {index, 0, 0}, count[3] = {1, n, parts};
    const int rank = array.second ? 3 : 2;
    const hdf5::Space from(hdf5::checked(H5Dget_space(set), "read a frame's shape"));
    const hdf5::Space to(hdf5::checked(H5Screate_simple(rank, count, nullptr), "make a frame's shape"));
    hdf5::checked(H5Sselect_hyperslab(from, H5S_SELECT_SET, start, nullptr, count, nullptr), "select a frame");
    hdf5::checked(H5Dread(set, H5T_NATIVE_DOUBLE, to, from, H5P_DEFAULT, row.data()), "read a frame");
    const auto spread = [&](std::vector<double>& values, std::size_t part) {
      values.resize(n);
      for (std::size_t i = 0; i < n; ++i) values[i] = row[i * parts + part];
    };
    spread(frame.*array.first, 0);
    if (array.second) spread(frame.*array.second, 1);
  }
};

RunReader::RunReader(const fs::path& path) {
  const auto held = hdf5::lock();
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->file = hdf5::open_input(path, "a run file");
  if (!holds_run(impl->file)) throw InputError(path.string(), "is an HDF5 file but not a run; give a run file");
  try {
    impl->read();
  } catch (const hdf5::Failure& e) {
    throw InputError(path.string(), std::string("is not a whole run file: ") + e.what());
  } catch (const std::bad_alloc&) {
    throw InputError(path.string(), "is too large for this machine's memory");
  }
  impl_ = std::move(impl);
}

RunReader::~RunReader() {
  const auto held = hdf5::lock();
  impl_.reset();
}
RunReader::RunReader(RunReader&&) noexcept = default;

Frame RunReader::frame(std::size_t index) const {
  const Impl& r = *impl_;
  Frame frame = r.without_balls(index);
  const auto held = hdf5::lock();
  try {
    for (std::size_t i = 0; i < r.balls.size(); ++i) r.read_balls(index, all_ball_arrays()[i], r.balls[i], frame);
  } catch (const hdf5::Failure& e) {
    throw InputError(r.path.string(), e.what());
  }
  return frame;
}

Observables RunReader::observables(std::size_t index) const { return impl_->without_balls(index).observed; }

const RunSetup& RunReader::setup() const { return impl_->setup; }
std::size_t RunReader::frame_count() const { return impl_->frames; }
const std::vector<double>& RunReader::time() const { return impl_->time; }
const std::vector<double>& RunReader::torque() const { return impl_->series.front(); }
const RunResult& RunReader::result() const { return impl_->result; }
bool RunReader::complete() const { return impl_->complete; }
std::string RunReader::version() const { return impl_->version; }

bool is_run_file(const fs::path& path) {
  if (!hdf5::is_hdf5(path)) return false;
  const auto held = hdf5::lock();
  try {
    return holds_run(hdf5::open_file(path, hdf5::Access::kRead));
  } catch (const hdf5::Failure&) {
    return false;
  }
}

}  // namespace tumble::io
