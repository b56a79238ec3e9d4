#include "io/run_file.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include "core/error.h"
#include "core/random.h"
#include "io/config_file.h"
#include "io/hdf5.h"
#include "io/run_layout.h"
#include "tests/io/folder.h"
#include "tests/support/checkpoints.h"

namespace tumble::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

RunSetup small_run(std::int64_t frames = 12) {
  RunSetup setup;
  setup.config = parse_config(
      "[mill]\ndiameter = 0.545\nspeed = 0.7\n[charge]\ncount = 3\n"
      "balls = [ { radius = 0.012, mass = 0.06 } ]\n[run]\nseed = 5\n",
      "mill.toml");
  setup.balls = {{0.012, 0.012, 1.0 / 3}, {0.06, 0.06, 0.1}};
  setup.time_step = 1e-5 / 3;
  setup.mill_speed = 4.2;
  setup.frame_count = frames;
  setup.dissipation_causes = {"sliding", "normal"};  // not in the order of the alphabet
  return setup;
}

// Every number differs from every other, and is one that single precision holds.
Frame frame_number(std::int64_t k) {
  const auto v = [k](int i) { return static_cast<double>(k) + i / 64.0; };
  Frame f;
  f.step = 500 * k;
  f.time = 0.005 * static_cast<double>(k);
  f.mill_angle = v(1) / 3;
  f.x = {v(2), v(3), v(4)};
  f.y = {v(5), v(6), v(7)};
  f.vx = {v(8), v(9), v(10)};
  f.vy = {v(11), v(12), v(13)};
  f.angle = {v(14), v(15), v(16)};
  f.spin = {v(17), v(18), v(19)};
  f.observed = {v(20) / 3, v(21), v(22), v(23), v(24), v(25), v(26), v(27), v(31), {v(28), v(29)}, v(30)};
  return f;
}

void expect_frame(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.mill_angle, b.mill_angle);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.vx, b.vx);
  EXPECT_EQ(a.vy, b.vy);
  EXPECT_EQ(a.angle, b.angle);
  EXPECT_EQ(a.spin, b.spin);
  const Observables &p = a.observed, &q = b.observed;
  EXPECT_EQ(std::tie(p.torque, p.torque_shear, p.torque_closure, p.torque_external, p.power, p.kinetic, p.potential,
                     p.elastic, p.drive_work, p.dissipation, p.locked_balls),
            std::tie(q.torque, q.torque_shear, q.torque_closure, q.torque_external, q.power, q.kinetic, q.potential,
                     q.elastic, q.drive_work, q.dissipation, q.locked_balls));
}

// Every array of the result has numbers and a length of its own.
RunResult make_result() {
  RunResult result;
  double next = 0;
  for (const run_layout::ResultArray& array : run_layout::all_result_arrays()) {
    for (int n = 0; n <= static_cast<int>(next) % 5; ++n) array.of(result).push_back(next += 0.5);
  }
  result.spin_up_revolutions = 2.25;
  result.steady = false;
  result.caveat = "12 balls are locked";
  return result;
}
const RunResult kResult = make_result();
constexpr std::size_t kWords = 40;

KeptCheckpoint words_at(std::int64_t frames) {
  return {frames, std::vector<double>(kWords - 7, 1.0 / static_cast<double>(frames + 1))};
}
Checkpoint checkpoint_at(std::int64_t frames) { return told(words_at(frames)); }

void write_run(const fs::path& path, const RunSetup& setup) {
  RunWriter writer(path, setup, kWords);
  for (std::int64_t k = 0; k < setup.frame_count; ++k) {
    writer.write(frame_number(k));
    if (k % 5 == 4) writer.write(checkpoint_at(k + 1));
  }
  writer.finish(kResult);
}

class RunFile : public InFolder {
 protected:
  fs::path run_ = folder_ / "run.h5", part_ = folder_ / "run.h5.part";

  static std::string refusal(const fs::path& path) {
    try {
      RunReader reader(path);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }
};

TEST_F(RunFile, GivesBackConfigSetupFramesAndResult) {
  const RunSetup setup = small_run();
  write_run(run_, setup);
  EXPECT_FALSE(fs::exists(part_));
  EXPECT_TRUE(is_run_file(run_));

  const RunReader reader(run_);
  EXPECT_TRUE(reader.complete());
  EXPECT_EQ(to_toml(reader.setup().config), to_toml(setup.config));
  EXPECT_EQ(reader.setup().balls.radius, setup.balls.radius);
  EXPECT_EQ(reader.setup().balls.mass, setup.balls.mass);
  EXPECT_EQ(reader.setup().time_step, setup.time_step);
  EXPECT_EQ(reader.setup().mill_speed, setup.mill_speed);
  EXPECT_EQ(reader.setup().frame_count, setup.frame_count);
  EXPECT_EQ(reader.setup().dissipation_causes, setup.dissipation_causes);
  ASSERT_EQ(reader.frame_count(), 12u);
  for (std::size_t k = 0; k < 12; ++k) expect_frame(reader.frame(k), frame_number(static_cast<std::int64_t>(k)));
  EXPECT_EQ(reader.time().at(3), frame_number(3).time);
  EXPECT_EQ(reader.torque().at(3), frame_number(3).observed.torque);
  for (const run_layout::ResultArray& array : run_layout::all_result_arrays())
    EXPECT_EQ(values(array, reader.result()), values(array, kResult)) << array.path;
  EXPECT_EQ(reader.result().spin_up_revolutions, 2.25);
  EXPECT_FALSE(reader.result().steady);
  EXPECT_EQ(reader.result().caveat, kResult.caveat);
  EXPECT_THROW(reader.frame(12), InputError);
}

TEST_F(RunFile, HasTheNamesAndUnitsOthersRelyOn) {
  write_run(run_, small_run());
  const auto held = hdf5::lock();
  const auto file = hdf5::open_file(run_, hdf5::Access::kRead);
  EXPECT_EQ(hdf5::read_attribute(hdf5::make_group(file, "h5md"), "version"), (std::vector{1, 1}));
  for (const char* element :
       {"particles/balls/position", "particles/balls/velocity", "particles/balls/angle",
        "particles/balls/angular_velocity", "observables/torque", "observables/torque_shear",
        "observables/torque_closure", "observables/power", "observables/mill_angle", "observables/energy/kinetic",
        "observables/energy/potential", "observables/energy/elastic", "observables/drive_work",
        "observables/dissipation/sliding", "observables/locked_balls"})
    for (const char* part : {"/step", "/time", "/value"})
      EXPECT_TRUE(hdf5::exists(file, std::string(element) + part)) << element << part;
  for (const char* array : {"particles/balls/radius", "particles/balls/mass", "observables/impact_spectrum/ball_ball",
                            "observables/impact_spectrum/ball_wall"})
    EXPECT_TRUE(hdf5::exists(file, array)) << array;
  EXPECT_EQ(hdf5::read_array<double>(file, "observables/impact_spectrum/ball_ball").size(),
            kResult.spectrum.ball_ball.size());
}

// Opened by hand in ParaView 5.11 (docs/run-file.md); here: one grid per frame, each with its own slab of the run.
TEST_F(RunFile, SideCarPointsIntoTheRun) {
  write_run(folder_ / "a&b.h5", small_run());
  const std::string text = bytes_of(folder_ / "a&b.xdmf");
  EXPECT_THAT(text, HasSubstr("a&amp;b.h5:/particles/balls/position/value"));
  std::size_t grids = 0;
  for (auto at = text.find("<Grid Name=\"frame\">"); at != std::string::npos;
       at = text.find("<Grid Name=\"frame\">", at + 1))
    ++grids;
  EXPECT_EQ(grids, 12u);
  EXPECT_THAT(text, HasSubstr("Format=\"XML\">11 0 0 1 1 1 1 3 2<"));  // the last frame: start, stride, count
}

TEST_F(RunFile, SameRunSameBytes) {
  write_run(run_, small_run());
  const std::string once = bytes_of(run_);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5 counts time in seconds
  write_run(folder_ / "again.h5", small_run());
  EXPECT_TRUE(once == bytes_of(folder_ / "again.h5"));
}

// More than the program's usual room, each with impacts of its own.
TEST_F(RunFile, HoldsAnyNumberOfLifters) {
  RunSetup setup = small_run();
  setup.config.mill.diameter = 100;
  setup.config.mill.lifters.count = 3000;
  RunResult result = kResult;
  for (int k = 0; k < 3000; ++k) result.places.lifter_power.push_back(k);
  result.places.lifter_power.resize(3000);
  RunWriter writer(run_, setup, kWords);
  for (int k = 0; k < 12; ++k) writer.write(frame_number(k));
  writer.finish(result);
  EXPECT_EQ(RunReader(run_).result().places.lifter_power, result.places.lifter_power);
}

TEST_F(RunFile, InterruptedRunIsReadableUpToItsLastFrame) {
  {
    RunWriter writer(run_, small_run(), kWords);
    for (int k = 0; k < 7; ++k) writer.write(frame_number(k));
  }
  EXPECT_FALSE(fs::exists(run_));
  EXPECT_THAT(refusal(run_), HasSubstr("no such file; an interrupted one is there as "));
  const RunReader reader(part_);
  EXPECT_FALSE(reader.complete());
  EXPECT_EQ(reader.setup().frame_count, 12);
  ASSERT_EQ(reader.frame_count(), 7u);
  EXPECT_EQ(reader.time().size(), 7u);
  expect_frame(reader.frame(6), frame_number(6));
}

TEST_F(RunFile, ResumedRunHasTheBytesOfAnUndisturbedOne) {
  const RunSetup setup = small_run();
  write_run(folder_ / "whole.h5", setup);
  {
    RunWriter writer(run_, setup, kWords);
    for (int k = 0; k < 9; ++k) {
      writer.write(frame_number(k));
      if (k == 2 || k == 5) writer.write(checkpoint_at(k + 1));
    }
  }
  const auto checkpoint = read_checkpoint(run_, setup.config);
  ASSERT_TRUE(checkpoint);
  EXPECT_EQ(checkpoint->frames_written, 6);
  EXPECT_EQ(keep(*checkpoint).words, words_at(6).words);
  RunWriter writer = RunWriter::resume(run_, setup);
  EXPECT_EQ(RunReader(part_).frame_count(), 6u);  // what came after the checkpoint is gone
  for (int k = 6; k < 12; ++k) writer.write(frame_number(k));
  writer.finish(kResult);
  EXPECT_TRUE(bytes_of(run_) == bytes_of(folder_ / "whole.h5"));
}

TEST_F(RunFile, ATornCheckpointLeavesTheOneBefore) {
  const RunSetup setup = small_run();
  {
    RunWriter writer(run_, setup, kWords);
    for (int k = 0; k < 9; ++k) {
      writer.write(frame_number(k));
      if (k == 2 || k == 5) writer.write(checkpoint_at(k + 1));
    }
  }
  std::string bytes = bytes_of(part_);
  const double word = 1.0 / 7;  // of the newest
  const auto at = bytes.find(std::string(reinterpret_cast<const char*>(&word), sizeof word));
  ASSERT_NE(at, std::string::npos);
  bytes[at + 100] = static_cast<char>(bytes[at + 100] ^ 1);
  write_bytes(part_, bytes);
  EXPECT_EQ(read_checkpoint(run_, setup.config)->frames_written, 3);
}

TEST_F(RunFile, ResumeRefusesAnotherRun) {
  RunSetup setup = small_run();
  EXPECT_FALSE(read_checkpoint(run_, setup.config));
  {
    RunWriter writer(run_, setup, kWords);
    writer.write(frame_number(0));
    EXPECT_FALSE(read_checkpoint(run_, setup.config));  // none yet: start afresh
    writer.write(checkpoint_at(1));
  }
  setup.config.mill.speed = 0.8;
  try {
    read_checkpoint(run_, setup.config);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("there speed = 0.7, here speed = 0.8"));
  }
  EXPECT_THROW(RunWriter::resume(run_, setup), InputError);
  EXPECT_TRUE(fs::exists(part_));
  write_bytes(part_, "something else");
  EXPECT_THROW(read_checkpoint(run_, setup.config), InputError);
}

TEST_F(RunFile, OneWriterAtATimeAndReadersWelcome) {
  const RunSetup setup = small_run();
  RunWriter writer(run_, setup, kWords);
  for (int k = 0; k < 12; ++k) writer.write(frame_number(k));
  EXPECT_THROW(RunWriter(run_, setup, kWords), WorkError);
  // Another program has the run open while it ends.
  int opened[2];
  ASSERT_EQ(pipe(opened), 0);
  const pid_t watcher = fork();
  if (watcher == 0) {
    const RunReader watching(part_);
    if (::write(opened[1], "o", 1) == 1) pause();
    _exit(1);
  }
  char told = 0;
  ASSERT_EQ(::read(opened[0], &told, 1), 1);
  writer.finish(kResult);
  kill(watcher, SIGKILL);
  waitpid(watcher, nullptr, 0);
  close(opened[0]);
  close(opened[1]);
  EXPECT_TRUE(RunReader(run_).complete());
}

TEST_F(RunFile, RefusesWhatIsNoRun) {
  EXPECT_THAT(refusal(run_), HasSubstr("run.h5: no such file; give a run file"));
  EXPECT_THAT(refusal(folder_), HasSubstr("is a folder; give a run file"));
  write_bytes(run_, "[mill]\ndiameter = 1\n");
  EXPECT_THAT(refusal(run_), HasSubstr("is not an HDF5 file"));
  write_bytes(run_, "");
  EXPECT_THAT(refusal(run_), HasSubstr("is not an HDF5 file"));
  {
    const auto held = hdf5::lock();
    auto file = hdf5::create_file(run_);
    hdf5::write_scalar<double>(file, "x", 1);
  }
  EXPECT_FALSE(is_run_file(run_));
  EXPECT_THAT(refusal(run_), HasSubstr("is an HDF5 file but not a run"));
}

TEST_F(RunFile, RefusesATruncatedFileAtAnyLength) {
  write_run(run_, small_run());
  const std::string whole = bytes_of(run_);
  for (std::size_t size = 0; size < whole.size(); size += whole.size() / 97) {
    write_bytes(run_, whole.substr(0, size));
    EXPECT_THAT(refusal(run_), size < 8 ? HasSubstr("is not an HDF5 file") : HasSubstr("cut off or damaged")) << size;
  }
}

// Runs `work` in a child that ends without this process's destructors; gives its exit status.
int in_child(const std::function<int()>& work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST_F(RunFile, SurvivesKillAtAnyMoment) {
  constexpr int kFrames = 3000;  // many, for a frame takes about as long as a signal
  const RunSetup setup = small_run(kFrames);
  auto* written = static_cast<std::atomic<int>*>(
      mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0));
  ASSERT_NE(written, MAP_FAILED);
  const auto run = [&] {
    RunWriter writer(run_, setup, kWords);
    for (int k = 0; k < kFrames; ++k) {
      writer.write(frame_number(k));
      written->store(k + 1);
      if (k % 5 == 4) writer.write(checkpoint_at(k + 1));
    }
    writer.finish(kResult);
    return 0;
  };
  Random random(3);
  int cut = 0;
  for (int trial = 0; trial < 40; ++trial) {
    fs::remove(run_);
    fs::remove(part_);
    written->store(0);
    // Some moment in a frame chosen by lot, or (the last third) in the laying out or the end.
    const int frame = std::min(static_cast<int>(random.below(kFrames * 3 / 2)) - kFrames / 4, kFrames);
    const double wait_us = random.uniform(0, frame < 0 || frame == kFrames ? 3000 : 30);
    const pid_t child = fork();
    if (child == 0) _exit(run());
    while (written->load() < frame) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::duration<double, std::micro>(wait_us));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);

    if (fs::exists(run_)) {
      EXPECT_TRUE(RunReader(run_).complete());
      continue;
    }
    if (!fs::exists(part_)) {
      EXPECT_EQ(written->load(), 0);
      continue;
    }
    ++cut;
    const RunReader reader(part_);
    ASSERT_GE(static_cast<int>(reader.frame_count()), written->load());
    for (std::size_t k = 0; k < reader.frame_count(); k += k + 20 < reader.frame_count() ? 17 : 1)
      expect_frame(reader.frame(k), frame_number(static_cast<std::int64_t>(k)));
    if (reader.complete()) {
      EXPECT_TRUE(adopt_complete_run(run_, setup.config));
      EXPECT_TRUE(RunReader(run_).complete());
    } else if (reader.frame_count() > 10) {
      EXPECT_GE(read_checkpoint(run_, setup.config).value().frames_written + 10,
                static_cast<std::int64_t>(reader.frame_count()));
    }
  }
  munmap(written, sizeof(std::atomic<int>));
  EXPECT_GE(cut, 10);  // or the moments were badly chosen
}

TEST_F(RunFile, FullDiskNamesTheReasonAndKeepsTheFrames) {
  const RunSetup setup = small_run();
  const auto limit_size = [](rlim_t bytes) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    setrlimit(RLIMIT_FSIZE, &limit);
  };
  const auto complains = [](const std::function<void()>& work) {
    try {
      work();
    } catch (const WorkError& e) {
      return std::string(e.what()).find("run.h5") != std::string::npos &&
             std::string(e.what()).find("File too large") != std::string::npos;
    }
    return false;
  };
  // From the start: nothing is left behind.
  EXPECT_EQ(in_child([&] {
              limit_size(4096);
              return complains([&] { RunWriter(run_, setup, kWords); }) ? 0 : 1;
            }),
            0);
  EXPECT_TRUE(fs::is_empty(folder_));
  // In the middle, where the disk did not keep its promise: what was written stays readable.
  constexpr std::size_t kMany = 2000;  // frames of fewer go through memory
  RunSetup large = setup;
  large.balls = {std::vector<double>(kMany, 0.012), std::vector<double>(kMany, 0.06)};
  const auto large_frame = [](std::int64_t k) {
    Frame frame = frame_number(k);
    for (auto* v : {&frame.x, &frame.y, &frame.vx, &frame.vy, &frame.angle, &frame.spin}) v->resize(kMany, 0.5);
    return frame;
  };
  EXPECT_EQ(in_child([&] {
              RunWriter writer(run_, large, kWords);
              for (int k = 0; k < 5; ++k) writer.write(large_frame(k));
              limit_size(4096);
              return complains([&] { writer.write(large_frame(5)); }) ? 0 : 1;
            }),
            0);
  const RunReader reader(part_);
  ASSERT_EQ(reader.frame_count(), 5u);
  expect_frame(reader.frame(4), large_frame(4));
}

}  // namespace
}  // namespace tumble::io
