#include "io/motion_file.h"

#include <gmock/gmock.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/error.h"
#include "core/motion_quantities.h"
#include "io/hdf5.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// Every number differs from every other; some are not known.
ChargeMotion a_motion(MotionSource source) {
  double next = 1.0 / 3;
  const auto v = [&next] { return next += 1.0 / 7; };
  ChargeMotion m;
  m.source = source;
  m.origin = "lab film \"1\" <ü>.mp4";
  m.rotation = Rotation::kClockwise;
  m.lifter_count = 18;
  m.mill_radius = v();
  m.tip_radius = v();
  m.frames = 3;
  m.frames_per_second = v();
  m.frames_per_second_se = v();
  m.duplicated_frames = {2, 5};
  m.dropped_frames = {7};
  for (const MotionQuantity& q : kMotionQuantities) m.*q.of = {v(), v()};
  m.departure_deg = {};
  m.filling.se = kNotGiven;
  m.camera = {v(), v(), v(), v(), {v(), v()}, {v(), v()}, 1280, 720, v(), v(), v(), v(), {}};
  for (double& o : m.ring_occupancy) o = v();
  m.ring_occupancy[17] = kNotGiven;
  for (double& o : m.ring_occupancy_se) o = v();
  m.profile = {{0, 0.0, v(), v(), v(), v()}, {1, v(), v(), kNotGiven, v(), v()}};
  m.tracks = {{0, 4, 0.0, v(), v(), v(), v(), v(), v(), v(), v(), v(), v(), v()},
              {0, 9, 0.0, v(), v(), v(), v(), v(), kNotGiven, v(), v(), v(), v(), kNotGiven}};
  m.surface = {{v(), v(), v()}, {v(), v(), kNotGiven}};
  if (source == MotionSource::kRunFile) m.torque_series = {{0.005, v(), v()}, {0.01, v(), v()}};
  m.field.cell = v();
  m.field.n = 2;
  for (auto* values : {&m.field.occupancy, &m.field.occupancy_se, &m.field.vx, &m.field.vy, &m.field.vx_se,
                       &m.field.vy_se, &m.field.temperature})
    *values = {v(), kNotGiven, v(), v()};
  if (source == MotionSource::kFilm) {
    MillCamera lens{v(), v(), v(), v(), v()};
    lens.rotation = Eigen::Matrix3d::NullaryExpr([&](Eigen::Index, Eigen::Index) { return v(); });
    lens.translation = {v(), v(), v()};
    m.camera.lens = lens;
  }
  m.caveats = {"the front glass is scratched", "second"};
  return m;
}

// All the numbers of a motion in one row, as bits: NaN equals NaN.
std::vector<std::uint64_t> numbers_of(const ChargeMotion& m) {
  std::vector<std::uint64_t> bits;
  const auto add = [&](double x) { bits.push_back(std::bit_cast<std::uint64_t>(x)); };
  for (double x : {m.mill_radius, m.tip_radius, m.frames_per_second, m.camera.centre_u_px, m.camera.centre_v_px,
                   m.camera.radius_px, m.camera.metres_per_pixel, m.camera.roll_deg.value, m.camera.roll_deg.se,
                   m.field.cell, m.frames_per_second_se, m.camera.centre_u_px_se, m.camera.centre_v_px_se,
                   m.camera.radius_px_se, m.camera.metres_per_pixel_se, m.camera.k1.value, m.camera.k1.se})
    add(x);
  for (const MotionQuantity& q : kMotionQuantities) add((m.*q.of).value), add((m.*q.of).se);
  for (double o : m.ring_occupancy) add(o);
  for (double o : m.ring_occupancy_se) add(o);
  for (const auto& r : m.profile)
    for (double x : {double(r.frame), r.time, r.mill_angle_deg, r.toe_deg, r.shoulder_deg, r.head}) add(x);
  for (const auto& p : m.tracks)
    for (double x : {double(p.frame), double(p.id), p.time, p.x, p.y, p.vx, p.vy, p.radius, p.spin, p.u_px, p.v_px,
                     p.x_se, p.visible, p.confidence})
      add(x);
  for (const auto& p : m.surface)
    for (double x : {p.x, p.y, p.se}) add(x);
  for (const auto& r : m.torque_series)
    for (double x : {r.time, r.torque, r.power}) add(x);
  for (const auto* values : {&m.field.occupancy, &m.field.occupancy_se, &m.field.vx, &m.field.vy, &m.field.vx_se,
                             &m.field.vy_se, &m.field.temperature})
    for (double x : *values) add(x);
  if (m.camera.lens) {
    const MillCamera& lens = *m.camera.lens;
    for (double x : {lens.focal, lens.centre_u, lens.centre_v, lens.k1, lens.k2}) add(x);
    for (double x : lens.rotation.reshaped()) add(x);
    for (double x : lens.translation) add(x);
  }
  for (int n : {m.lifter_count, m.frames, m.camera.width_px, m.camera.height_px, m.field.n}) add(n);
  for (int n : m.duplicated_frames) add(n);
  for (int n : m.dropped_frames) add(n);
  return bits;
}

class MotionFile : public InFolder {
 protected:
  fs::path file_ = folder_ / "motion.h5";
  std::string refusal() const {
    try {
      read_motion(file_);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  }
};

TEST_F(MotionFile, GivesBackEveryBit) {
  for (const MotionSource source : {MotionSource::kRunFile, MotionSource::kFilm, MotionSource::kStills}) {
    const ChargeMotion m = a_motion(source);
    write_motion(file_, m);
    EXPECT_TRUE(is_motion_file(file_));
    const ChargeMotion back = read_motion(file_);
    EXPECT_EQ(numbers_of(back), numbers_of(m));
    EXPECT_EQ(back.source, m.source);
    EXPECT_EQ(back.rotation, m.rotation);
    EXPECT_EQ(back.origin, m.origin);
    EXPECT_EQ(back.caveats, m.caveats);
  }
}

TEST_F(MotionFile, AnEmptyMotionIsAMotion) {
  write_motion(file_, {});
  EXPECT_EQ(numbers_of(read_motion(file_)), numbers_of({}));
}

TEST_F(MotionFile, RefusesWhatIsNoMotion) {
  EXPECT_THAT(refusal(), HasSubstr("motion.h5: no such file; give a motion file"));
  write_bytes(file_, "frame,time_s\n");
  EXPECT_THAT(refusal(), HasSubstr("is not an HDF5 file"));
  write_motion(file_, a_motion(MotionSource::kFilm));
  const std::string whole = bytes_of(file_);
  for (std::size_t size = 8; size < whole.size(); size += whole.size() / 50) {
    write_bytes(file_, whole.substr(0, size));
    EXPECT_THAT(refusal(), HasSubstr("cut off or damaged"));
  }
  {
    const auto held = hdf5::lock();
    hdf5::create_file(file_);
  }
  EXPECT_FALSE(is_motion_file(file_));
  EXPECT_THAT(refusal(), HasSubstr("is an HDF5 file but no motion file"));
  {
    const auto held = hdf5::lock();
    const auto file = hdf5::create_file(file_);
    hdf5::write_scalar<int>(file, "motion_file_format", 1);
  }
  EXPECT_THAT(refusal(), HasSubstr("is not a whole motion file: "));
}

TEST_F(MotionFile, SummaryNamesWhatTheContractNames) {
  const auto s = nlohmann::json::parse(summary_json(a_motion(MotionSource::kFilm)));
  for (const char* quantity : {"speed_rpm",
                               "speed_fraction",
                               "filling",
                               "toe_deg",
                               "shoulder_deg",
                               "toe_bulk_deg",
                               "shoulder_bulk_deg",
                               "toe_outer_deg",
                               "shoulder_outer_deg",
                               "head_m",
                               "surface_angle_deg",
                               "flight_share",
                               "circulation_time_s",
                               "granular_temperature_m2_s2",
                               "centre_of_circulation_m",
                               "departure_deg",
                               "impact_toe_deg",
                               "mill_centre_px",
                               "mill_radius_px",
                               "metres_per_pixel",
                               "roll_deg",
                               "k1",
                               "frames_per_second"}) {
    EXPECT_TRUE(s.contains(quantity)) << quantity;
    EXPECT_TRUE(s.contains(std::string(quantity) + "_se")) << quantity;
  }
  EXPECT_EQ(s["rotation"], "clockwise");
  EXPECT_EQ(s["frames"], 3);
  EXPECT_EQ(s["duplicated_frames"], nlohmann::json({2, 5}));
  EXPECT_EQ(s["dropped_frames"], nlohmann::json({7}));
  EXPECT_TRUE(s["departure_deg"].is_null());
  EXPECT_TRUE(s["filling_se"].is_null());
  EXPECT_EQ(s["centre_of_circulation_m"].size(), 2u);
  EXPECT_NEAR(s["toe_deg"].get<double>(), a_motion(MotionSource::kFilm).toe_deg.value, 1e-8);
  EXPECT_TRUE(nlohmann::json::parse(summary_json({}))["mill_centre_px"].is_null());
}

TEST_F(MotionFile, SummarySurvivesANameThatIsNoText) {
  ChargeMotion m;
  m.origin = "film\xff\xfe.mp4";
  EXPECT_NO_THROW(nlohmann::json::parse(summary_json(m)));
}

TEST_F(MotionFile, SummaryTellsEvenTheTiniestNumber) {
  ChargeMotion m;
  m.head = {1e-310, kNotGiven};
  EXPECT_GT(nlohmann::json::parse(summary_json(m))["head_m"].get<double>(), 0);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST_F(MotionFile, TablesHaveTheContractsColumns) {
  ChargeMotion m;
  m.source = MotionSource::kFilm;
  m.profile = {{0, 0.0, 12.5, 230.25, kNotGiven, 0.125}};
  m.tracks = {{3, 7, 0.015, 0.1234567, -0.2, 1.5, -2.5, 0.012, kNotGiven, 640.25, 359.5, 1.5e-4, 0.75, 0.99}};
  m.surface = {{-0.125, -0.0625, 0.00125}};
  m.ring_occupancy.fill(0.5);
  m.ring_occupancy[1] = kNotGiven;
  write_csv(folder_, m);
  EXPECT_EQ(bytes_of(folder_ / "profile.csv"),
            "frame,time_s,mill_angle_deg,toe_deg,shoulder_deg,head_m\n0,0,12.5000,230.250,,0.125000\n");
  EXPECT_EQ(bytes_of(folder_ / "tracks.csv"),
            "frame,time_s,id,x_m,y_m,vx_m_s,vy_m_s,radius_m,spin_rad_s,u_px,v_px,x_se_m,visible,confidence\n"
            "3,0.015,7,0.1234567,-0.2000000,1.5,-2.5,0.012,,640.250,359.500,0.00015,0.750,0.990\n");
  EXPECT_EQ(bytes_of(folder_ / "surface.csv"), "x_m,y_m,se_m\n-0.125000,-0.062500,0.00125\n");
  const auto occupancy = lines_of(bytes_of(folder_ / "occupancy.csv"));
  ASSERT_EQ(occupancy.size(), 361u);
  EXPECT_EQ(occupancy[0], "angle_deg,occupancy");
  EXPECT_EQ(occupancy[1], "0.5,0.500000");
  EXPECT_EQ(occupancy[2], "1.5,");
  EXPECT_FALSE(fs::exists(folder_ / "torque.csv"));

  m.source = MotionSource::kRunFile;
  m.tracks = {{3, 7, 0.015, 0.1234567, -0.2, 1.5, -2.5, 0.012, 40.5}};
  m.torque_series = {{0.005, 10.5, 42.25}};
  write_csv(folder_, m);
  EXPECT_EQ(bytes_of(folder_ / "torque.csv"), "time_s,torque_N_m,power_W\n0.005,10.5,42.25\n");
  EXPECT_EQ(lines_of(bytes_of(folder_ / "tracks.csv"))[1], "3,0.015,7,0.1234567,-0.2000000,1.5,-2.5,0.012,40.5,,,");
}

}  // namespace
}  // namespace tumble::io
