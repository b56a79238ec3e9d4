#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/version.h"
#include "io/config_file.h"
#include "io/hdf5.h"
#include "io/in_place_file.h"
#include "io/run_file.h"
#include "io/run_layout.h"
#include "io/xdmf_file.h"

// How a run file survives kill -9 at any moment. The number of frames is known beforehand, so HDF5 lays out the whole
// file at full size, closes it, and only then the file takes the name RUN.h5.part. From there on nothing but values
// changes: each frame is written in place at the offsets that HDF5 told, and then the counter `frames_written`. The
// bytes that describe the file are never touched, so it is a valid HDF5 file at every moment, and no library
// holds anything back. Rejected: growing datasets with a flush per frame (HDF5 does not promise that a file is
// whole between two writes of its metadata), and SWMR (such a file needs an SWMR reader once the writer has died).
namespace tumble::io {
namespace fs = std::filesystem;
using namespace run_layout;
namespace {

// Where things lie in the file [bytes from its begin].
struct Places {
  std::vector<std::uint64_t> series, dissipation, balls;
  std::uint64_t step = 0, time = 0, frames_written = 0, complete = 0, spin_up = 0, steady = 0, caveat = 0;
  std::uint64_t words = 0, slots = 0;
  std::size_t capacity = 0;  // words of a slot
};

Places find_places(hid_t file, const RunSetup& setup) {
  const auto at = [&](const std::string& path) { return hdf5::place_of(hdf5::open_array(file, path), path); };
  Places p;
  for (const Series& s : all_series()) p.series.push_back(at(std::string(s.path) + "/value"));
  for (const auto& cause : setup.dissipation_causes) p.dissipation.push_back(at(dissipation_path(cause) + "/value"));
  for (const BallArray& b : all_ball_arrays()) p.balls.push_back(at(std::string(b.path) + "/value"));
  p.step = at(kStep);
  p.time = at(kTime);
  p.frames_written = at(kFramesWritten);
  p.complete = at(kComplete);
  p.spin_up = at("parameters/spin_up_revolutions");
  p.steady = at("parameters/steady");
  p.caveat = at("parameters/caveat");
  const auto words = hdf5::open_array(file, kCheckpointWords);
  p.capacity = hdf5::count_of(words, kCheckpointWords) / 2;
  if (p.capacity > 0) p.words = hdf5::place_of(words, kCheckpointWords);
  p.slots = at(kCheckpointSlots);
  return p;
}

void lay_out_h5md(hid_t file) {
  const auto h5md = hdf5::make_group(file, "h5md");
  hdf5::set_attribute(h5md, "version", std::vector{1, 1});
  hdf5::set_attribute(hdf5::make_group(file, "h5md/author"), "name", "unknown");
  const auto creator = hdf5::make_group(file, "h5md/creator");
  hdf5::set_attribute(creator, "name", "tumble");
  hdf5::set_attribute(creator, "version", kVersion);
  const auto units = hdf5::make_group(file, "h5md/modules/units");
  hdf5::set_attribute(units, "version", std::vector{1, 0});
  hdf5::set_attribute(units, "system", "SI");
}

// A time-dependent element; all share one step and one time, as H5MD recommends.
void lay_out_element(hid_t file, const std::string& path, hid_t type, const hdf5::Shape& shape, const char* unit,
                     hdf5::Fill fill) {
  hdf5::make_array(file, path + "/value", type, shape, unit, fill);
  for (const char* shared : {kStep, kTime}) {
    const std::string name = std::string(shared).substr(std::string(shared).rfind('/'));
    if (path + name == shared) continue;
    hdf5::checked(H5Lcreate_hard(file, shared, file, (path + name).c_str(), H5P_DEFAULT, H5P_DEFAULT), "link " + path);
  }
}

// The arrays of the result get their true length at the end, within the one chunk that is set aside for each: then
// only a number in the dataset's own header changes, in one write, and a file that is cut off there stays whole.
void lay_out_result_array(hid_t file, const ResultArray& array, std::size_t space_set_aside) {
  hdf5::make_group(file, array.path.substr(0, array.path.rfind('/')));
  const hsize_t chunk = space_set_aside, unlimited = H5S_UNLIMITED;
  const hdf5::Properties creation(hdf5::checked(H5Pcreate(H5P_DATASET_CREATE), "make a property list"));
  hdf5::checked(H5Pset_obj_track_times(creation, false), "leave out times");
  hdf5::checked(H5Pset_chunk(creation, 1, &chunk), "set a chunk");
  hdf5::checked(H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY), "fix a dataset's place");
  const hdf5::Space space(hdf5::checked(H5Screate_simple(1, &chunk, &unlimited), "make a shape"));
  const hdf5::Dataset set(
      hdf5::checked(H5Dcreate2(file, array.path.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                    "make " + array.path));
  hdf5::set_attribute(set, "unit", array.unit);
}

void lay_out(hid_t file, const RunSetup& setup, std::size_t checkpoint_words) {
  const hsize_t frames = static_cast<hsize_t>(setup.frame_count), balls = setup.balls.size();
  hdf5::write_scalar<int>(file, kFormatPath, kFormat);
  lay_out_h5md(file);

  const auto box = hdf5::make_group(file, "particles/balls/box");
  hdf5::set_attribute(box, "dimension", std::vector{2});
  {
    const hdf5::Type text(hdf5::checked(H5Tcopy(H5T_C_S1), "make a string type"));
    hdf5::checked(H5Tset_size(text, 4), "size a string type");
    hdf5::checked(H5Tset_strpad(text, H5T_STR_NULLPAD), "pad a string type");
    const hsize_t two = 2;
    const hdf5::Space space(hdf5::checked(H5Screate_simple(1, &two, nullptr), "make a shape"));
    const hdf5::Attribute boundary(
        hdf5::checked(H5Acreate2(box, "boundary", text, space, H5P_DEFAULT, H5P_DEFAULT), "make boundary"));
    hdf5::checked(H5Awrite(boundary, text, "nonenone"), "write boundary");
  }
  hdf5::write_array<double>(file, "particles/balls/radius", setup.balls.radius, {balls}, "m");
  hdf5::write_array<double>(file, "particles/balls/mass", setup.balls.mass, {balls}, "kg");

  hdf5::make_array(file, kStep, H5T_NATIVE_INT64, {frames}, "", hdf5::Fill::kMinusOne);
  hdf5::make_array(file, kTime, H5T_NATIVE_DOUBLE, {frames}, "s", hdf5::Fill::kNan);
  for (const BallArray& b : all_ball_arrays())
    lay_out_element(file, b.path, H5T_NATIVE_FLOAT,
                    b.second ? hdf5::Shape{frames, balls, 2} : hdf5::Shape{frames, balls}, b.unit, hdf5::Fill::kNone);
  for (const Series& s : all_series())
    lay_out_element(file, s.path, H5T_NATIVE_DOUBLE, {frames}, s.unit, hdf5::Fill::kNan);
  for (const auto& cause : setup.dissipation_causes)
    lay_out_element(file, dissipation_path(cause), H5T_NATIVE_DOUBLE, {frames}, "J", hdf5::Fill::kNan);
  for (const ResultArray& array : all_result_arrays())
    lay_out_result_array(file, array, space_for(array, setup.config));

  hdf5::make_string(file, "parameters/config", to_toml(setup.config));
  hdf5::make_string(file, "parameters/version", kVersion);
  std::string causes;
  for (const auto& cause : setup.dissipation_causes) causes += cause + "\n";
  hdf5::make_string(file, "parameters/dissipation_causes", causes);
  hdf5::write_scalar<std::uint64_t>(file, "parameters/seed", setup.config.run.seed);
  hdf5::write_scalar<double>(file, "parameters/time_step", setup.time_step, "s");
  hdf5::write_scalar<double>(file, "parameters/mill_speed", setup.mill_speed, "rad s-1");
  hdf5::write_scalar<std::int64_t>(file, kFramesWritten, 0);
  hdf5::write_scalar<std::int64_t>(file, kComplete, 0);
  hdf5::write_scalar<double>(file, "parameters/spin_up_revolutions", kNotGiven);
  hdf5::write_scalar<std::int64_t>(file, "parameters/steady", 1);
  hdf5::make_string(file, "parameters/caveat", "", kCaveatCapacity);

  const std::vector<std::int64_t> empty_slots(8);
  hdf5::write_array<std::int64_t>(file, kCheckpointSlots, empty_slots, {2, 4});
  hdf5::make_array(file, kCheckpointWords, H5T_NATIVE_DOUBLE, {2, checkpoint_words});
}

void write_result_arrays(const fs::path& part, const RunResult& result) {
  const auto file = hdf5::open_file(part, hdf5::Access::kChange);
  for (const ResultArray& array : all_result_arrays()) {
    const std::vector<double>& numbers = values(array, result);
    const auto set = hdf5::open_array(file, array.path);
    const hdf5::Properties creation(hdf5::checked(H5Dget_create_plist(set), "read the room of " + array.path));
    hsize_t space = 0;
    hdf5::checked(H5Pget_chunk(creation, 1, &space), "read the room of " + array.path);
    const hsize_t size = numbers.size();
    if (size > space) throw WorkError(part.string(), array.path + " has at most " + std::to_string(space) + " numbers");
    hdf5::checked(H5Dset_extent(set, &size), "size " + array.path);
    if (!numbers.empty())
      hdf5::checked(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
                    "write " + array.path);
  }
  hdf5::checked(H5Fflush(file, H5F_SCOPE_LOCAL), "write the file");
}

// The newest slot whose words are whole, and where these lie.
struct WholeSlot {
  Slot slot;
  int index = 0;
  std::uint64_t words = 0;
};
std::optional<WholeSlot> newest_checkpoint(hid_t file, const InPlaceFile& bytes) {
  constexpr std::size_t kPiece = 8192;
  const auto numbers = hdf5::read_array<std::int64_t>(file, kCheckpointSlots, 8);
  const auto words = hdf5::open_array(file, kCheckpointWords);
  const std::size_t capacity = hdf5::count_of(words, kCheckpointWords) / 2;
  if (numbers.size() != 8) throw hdf5::Failure("the checkpoint has another shape");
  std::optional<WholeSlot> newest;
  for (std::size_t i = 0; i < 2; ++i) {
    const Slot slot{numbers[4 * i], numbers[4 * i + 1], numbers[4 * i + 2], numbers[4 * i + 3]};
    if (slot.sequence < 1 || slot.count < 0 || slot.count > static_cast<std::int64_t>(capacity)) continue;
    if (newest && slot.sequence < newest->slot.sequence) continue;
    const std::uint64_t place = hdf5::place_of(words, kCheckpointWords) + i * capacity * sizeof(double);
    const auto count = static_cast<std::size_t>(slot.count);
    Checksum sum(slot);
    std::vector<double> piece;
    for (std::size_t at = 0; at < count; at += piece.size()) {
      piece.resize(std::min(kPiece, count - at));
      bytes.read(place + at * sizeof(double), piece.data(), piece.size() * sizeof(double));
      sum.add(piece);
    }
    if (sum.value() == slot.checksum) newest = {slot, static_cast<int>(i), place};
  }
  return newest;
}

// The first line in which two configs differ, for a message.
std::string first_difference(const std::string& stored, const std::string& given) {
  std::size_t a = 0, b = 0;
  while (a < stored.size() || b < given.size()) {
    const auto line = [](const std::string& text, std::size_t& at) {
      const auto end = std::min(text.find('\n', at), text.size());
      const std::string found = at < text.size() ? text.substr(at, end - at) : "nothing";
      at = end + 1;
      return found;
    };
    const std::string one = line(stored, a), other = line(given, b);
    if (one != other) return "there " + one + ", here " + other;
  }
  return "";
}

void refuse_another_run(hid_t file, const fs::path& part, const Config& config) {
  const std::string version = hdf5::read_string(file, "parameters/version");
  if (version != kVersion)
    throw InputError(part.string(), "was begun by version " + version + ", this is " + kVersion +
                                        "; resume with that version or remove the file");
  const std::string difference = first_difference(hdf5::read_string(file, "parameters/config"), to_toml(config));
  if (!difference.empty())
    throw InputError(part.string(),
                     "was begun with another config (" + difference + "); resume with that config or remove the file");
}

InputError not_resumable(const fs::path& part, const std::string& why) {
  return InputError(part.string(), "is no interrupted run (" + why + "); remove it to start afresh");
}

void remove_quietly(const fs::path& path) {
  std::error_code ignored;
  fs::remove(path, ignored);
}

void sync_folder(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return;
  fsync(file);
  close(file);
}

void put_in_place(const fs::path& part, const fs::path& path) {
  std::error_code error;
  fs::rename(part, path, error);
  if (error) throw WorkError(path.string(), "cannot be put in place: " + error.message());
  sync_folder(path);
}

// Beforehand: HDF5 would write for hours before it found the disk full.
void check_space(const fs::path& path, const RunSetup& setup, std::size_t checkpoint_words) {
  double per_frame = 8.0 * double(2 + all_series().size() + setup.dissipation_causes.size());
  for (const BallArray& b : all_ball_arrays()) per_frame += double(sizeof(float) * b.components() * setup.balls.size());
  const double needed = per_frame * double(setup.frame_count) + 16.0 * double(checkpoint_words);
  std::error_code error;
  const auto space = fs::space(path.has_parent_path() ? path.parent_path() : fs::path("."), error);
  if (error || needed <= double(space.available)) return;
  char text[160];
  std::snprintf(text, sizeof text, "needs %.3g GB for %lld frames, %.3g GB are free; take fewer revolutions or frames",
                needed / 1e9, static_cast<long long>(setup.frame_count), double(space.available) / 1e9);
  throw WorkError(path.string(), text);
}

}  // namespace

struct RunWriter::Impl {
  fs::path path, part;
  std::int64_t frame_count = 0;
  std::size_t balls = 0;
  InPlaceFile file;
  Places places;
  std::int64_t frames_written = 0;
  Slot last_slot;
  int last_slot_index = 1;
  bool owns_part = false;
  std::vector<float> piece;  // of a frame's row

  ~Impl() {
    // A run that died before its first frame leaves nothing worth keeping.
    if (owns_part && frames_written == 0 && last_slot.sequence == 0) remove_quietly(part);
  }

  void write_frame(const Frame& frame) {
    if (frames_written >= frame_count)
      throw WorkError(part.string(), "has its " + std::to_string(frame_count) + " frames, cannot take another");
    const auto k = static_cast<std::uint64_t>(frames_written);
    const auto put = [&](std::uint64_t place, const auto& v) { file.write(place + k * sizeof v, &v, sizeof v); };
    for (std::size_t i = 0; i < places.balls.size(); ++i) write_balls(all_ball_arrays()[i], places.balls[i], k, frame);
    for (std::size_t i = 0; i < places.series.size(); ++i) put(places.series[i], value(all_series()[i], frame));
    for (std::size_t i = 0; i < places.dissipation.size(); ++i)
      put(places.dissipation[i], frame.observed.dissipation.at(i));
    put(places.step, frame.step);
    put(places.time, frame.time);
    set_frames_written(frames_written + 1);
  }

  void write_balls(const BallArray& array, std::uint64_t place, std::uint64_t k, const Frame& frame) {
    constexpr std::size_t kPiece = 8192;
    const std::size_t parts = array.components();
    place += k * balls * parts * sizeof(float);
    for (std::size_t from = 0; from < balls; from += kPiece) {
      const std::size_t n = std::min(kPiece, balls - from);
      piece.resize(n * parts);
      const auto& first = frame.*array.first;
      for (std::size_t i = 0; i < n; ++i) piece[i * parts] = static_cast<float>(first.at(from + i));
      if (array.second)
        for (std::size_t i = 0; i < n; ++i) piece[2 * i + 1] = static_cast<float>((frame.*array.second).at(from + i));
      file.write(place, piece.data(), piece.size() * sizeof(float));
      place += piece.size() * sizeof(float);
    }
  }

  void set_frames_written(std::int64_t count) {
    file.write(places.frames_written, &count, sizeof count);
    frames_written = count;
  }

  void write_checkpoint(const Checkpoint& checkpoint) {
    const auto check_size = [&](std::size_t size) {
      if (size > places.capacity)
        throw WorkError(part.string(), "a checkpoint of " + std::to_string(size) + " words exceeds the " +
                                           std::to_string(places.capacity) + " set aside");
    };
    check_size(checkpoint.size);
    Slot slot{last_slot.sequence + 1, checkpoint.frames_written, static_cast<std::int64_t>(checkpoint.size), 0};
    Checksum sum(slot);
    const int index = 1 - last_slot_index;
    const std::uint64_t place = places.words + index * places.capacity * sizeof(double);
    std::size_t told = 0;
    checkpoint.tell([&](std::span<const double> words) {
      check_size(told + words.size());
      sum.add(words);
      file.write(place + told * sizeof(double), words.data(), words.size_bytes());
      told += words.size();
    });
    slot.checksum = sum.value();
    file.write(places.slots + index * sizeof slot, &slot, sizeof slot);
    last_slot = slot;
    last_slot_index = index;
  }

  void drop_frames_from(std::int64_t first) {
    const std::int64_t had = frames_written;
    set_frames_written(first);
    const double nan = kNotGiven;
    const std::int64_t none = -1;
    for (std::int64_t k = first; k < had; ++k) {
      const auto at = static_cast<std::uint64_t>(k) * 8;
      for (const auto place : places.series) file.write(place + at, &nan, 8);
      for (const auto place : places.dissipation) file.write(place + at, &nan, 8);
      file.write(places.time + at, &nan, 8);
      file.write(places.step + at, &none, 8);
    }
  }

  void finish(const RunResult& result) {
    if (frames_written != frame_count)
      throw WorkError(part.string(), "ends after " + std::to_string(frames_written) + " of " +
                                         std::to_string(frame_count) + " frames");
    const std::int64_t steady = result.steady, complete = 1;
    std::string caveat = result.caveat;
    caveat.resize(kCaveatCapacity, '\0');
    file.write(places.spin_up, &result.spin_up_revolutions, sizeof(double));
    file.write(places.steady, &steady, sizeof steady);
    file.write(places.caveat, caveat.data(), caveat.size());
    {
      const auto held = hdf5::lock();
      write_result_arrays(part, result);
    }
    file.write(places.complete, &complete, sizeof complete);
    // Checkpoints have had their day, and would differ between a run that was interrupted and one that was not.
    file.wipe(places.slots, 2 * sizeof(Slot));
    file.wipe(places.words, 2 * places.capacity * sizeof(double));
    file.sync();
    put_in_place(part, path);
    owns_part = false;
    write_xdmf(path, frame_count, balls);
  }
};

RunWriter::RunWriter(const fs::path& path, const RunSetup& setup, std::size_t checkpoint_words)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->part = part_of(path);
  impl_->frame_count = setup.frame_count;
  impl_->balls = setup.balls.size();
  check_space(path, setup, checkpoint_words);
  // Laid out under a third name: a .part is whole from the moment it is there.
  fs::path layout = impl_->part;
  layout += ".new";
  try {
    const auto held = hdf5::lock();
    {
      auto file = hdf5::create_file(layout);
      lay_out(file, setup, checkpoint_words);
      impl_->places = find_places(file, setup);
      hdf5::close_file(std::move(file));
    }
    InPlaceFile file(layout, path);
    file.claim();
    file.reserve();
    if (fs::exists(impl_->part)) InPlaceFile(impl_->part, impl_->part).claim();  // not under another writer's feet
    fs::rename(layout, impl_->part);
    impl_->file = std::move(file);
    impl_->owns_part = true;
  } catch (const hdf5::Failure& e) {
    remove_quietly(layout);
    throw WorkError(path.string(), e.what());
  } catch (const fs::filesystem_error& e) {
    remove_quietly(layout);
    throw WorkError(path.string(), e.code().message());
  } catch (...) {
    remove_quietly(layout);
    throw;
  }
}

RunWriter RunWriter::resume(const fs::path& path, const RunSetup& setup) {
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->part = part_of(path);
  impl->frame_count = setup.frame_count;
  impl->balls = setup.balls.size();
  try {
    const auto held = hdf5::lock();
    const auto file = hdf5::open_file(impl->part, hdf5::Access::kRead);
    refuse_another_run(file, impl->part, setup.config);
    const auto checkpoint = newest_checkpoint(file, InPlaceFile(impl->part, impl->part));
    if (!checkpoint) throw hdf5::Failure("it has no checkpoint");
    const auto frames = hdf5::shape_of(hdf5::open_array(file, kTime), kTime);
    const auto radius = hdf5::read_array<double>(file, "particles/balls/radius");
    if (frames != hdf5::Shape{static_cast<hsize_t>(setup.frame_count)} || radius != setup.balls.radius)
      throw hdf5::Failure("it has other frames or balls than this run");
    impl->places = find_places(file, setup);
    impl->frames_written = hdf5::read_scalar<std::int64_t>(file, kFramesWritten);
    if (checkpoint->slot.frames_written > impl->frames_written)
      throw hdf5::Failure("its checkpoint is ahead of its frames");
    impl->last_slot = checkpoint->slot;
    impl->last_slot_index = checkpoint->index;
  } catch (const hdf5::Failure& e) {
    throw not_resumable(impl->part, e.what());
  }
  impl->file = InPlaceFile(impl->part, impl->part);
  impl->file.claim();
  impl->file.reserve();
  impl->drop_frames_from(impl->last_slot.frames_written);
  return RunWriter(std::move(impl));
}

RunWriter::RunWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RunWriter::~RunWriter() = default;
RunWriter::RunWriter(RunWriter&&) noexcept = default;
void RunWriter::write(const Frame& frame) { impl_->write_frame(frame); }
void RunWriter::write(const Checkpoint& checkpoint) { impl_->write_checkpoint(checkpoint); }
void RunWriter::finish(const RunResult& result) {
  try {
    impl_->finish(result);
  } catch (const hdf5::Failure& e) {
    throw WorkError(impl_->part.string(), e.what());
  }
}

std::optional<StoredCheckpoint> read_checkpoint(const fs::path& path, const Config& config) {
  const fs::path part = part_of(path);
  std::error_code error;
  if (!fs::exists(part, error)) return std::nullopt;
  try {
    const auto held = hdf5::lock();
    const auto file = hdf5::open_file(part, hdf5::Access::kRead);
    refuse_another_run(file, part, config);
    const auto bytes = std::make_shared<InPlaceFile>(part, part);
    const auto newest = newest_checkpoint(file, *bytes);
    if (!newest) return std::nullopt;
    return StoredCheckpoint{newest->slot.frames_written, static_cast<std::size_t>(newest->slot.count),
                            [bytes, place = newest->words](std::span<double> words) mutable {
                              bytes->read(place, words.data(), words.size_bytes());
                              place += words.size_bytes();
                            }};
  } catch (const hdf5::Failure& e) {
    throw not_resumable(part, e.what());
  }
}

bool adopt_complete_run(const fs::path& path, const Config& config) {
  const fs::path part = part_of(path);
  std::error_code error;
  if (!fs::exists(part, error)) return false;
  RunSetup setup;
  {
    const RunReader run(part);
    if (!run.complete()) return false;
    setup = run.setup();
    const auto held = hdf5::lock();
    refuse_another_run(hdf5::open_file(part, hdf5::Access::kRead), part, config);
  }
  {
    const InPlaceFile file(part, part);
    file.claim();
    const auto held = hdf5::lock();
    const Places places = find_places(hdf5::open_file(part, hdf5::Access::kRead), setup);
    file.wipe(places.slots, 2 * sizeof(Slot));
    file.wipe(places.words, 2 * places.capacity * sizeof(double));
    file.sync();
  }
  put_in_place(part, path);
  write_xdmf(path, setup.frame_count, setup.balls.size());
  return true;
}

}  // namespace tumble::io
