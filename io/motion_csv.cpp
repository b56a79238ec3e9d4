#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/motion_quantities.h"
#include "io/json_number.h"
#include "io/motion_file.h"
#include "io/output.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return json_number(v, 9); }
Json error(double v) { return json_number(v, 4); }
Json pair(const Json& x, const Json& y) { return x.is_null() && y.is_null() ? Json(nullptr) : Json{x, y}; }

void put(Json& summary, const std::string& name, double value, double se = kNotGiven) {
  summary[name] = number(value);
  summary[name + "_se"] = error(se);
}

// One table as text, line by line to the disk: tracks of a long film need not fit in memory twice.
class Table {
 public:
  Table(const fs::path& path, const char* header) : path_(path), staged_(path), out_(staged_.path(), std::ios::binary) {
    out_ << header << '\n';
  }
  // "nothing" stands for a number that cannot be had.
  Table& whole(int v) { return add(fmt::format("{}", v)); }
  Table& digits(double v, int n) { return add(std::isfinite(v) ? fmt::format("{:.{}g}", v, n) : ""); }
  Table& decimals(double v, int n) { return add(std::isfinite(v) ? fmt::format("{:.{}f}", v, n) : ""); }
  void end_line() {
    line_.back() = '\n';
    out_ << line_;
    line_.clear();
  }
  void finish() {
    errno = 0;
    out_.close();
    if (!out_) throw WorkError(path_.string(), std::string("cannot be written: ") + std::strerror(errno ? errno : EIO));
    staged_.commit();
  }

 private:
  Table& add(const std::string& cell) {
    line_ += cell;
    line_ += ',';
    return *this;
  }
  fs::path path_;
  StagedFile staged_;
  std::ofstream out_;
  std::string line_;
};

void write_profile(const fs::path& path, const ChargeMotion& m) {
  Table table(path, "frame,time_s,mill_angle_deg,toe_deg,shoulder_deg,head_m");
  for (const ProfileRow& r : m.profile)
    table.whole(r.frame)
        .digits(r.time, 9)
        .decimals(r.mill_angle_deg, 4)
        .decimals(r.toe_deg, 3)
        .decimals(r.shoulder_deg, 3)
        .decimals(r.head, 6)
        .end_line();
  table.finish();
}

void write_tracks(const fs::path& path, const ChargeMotion& m) {
  const bool film = m.source != MotionSource::kRunFile;
  Table table(path,
              film ? "frame,time_s,id,x_m,y_m,vx_m_s,vy_m_s,radius_m,spin_rad_s,u_px,v_px,x_se_m,visible,confidence"
                   : "frame,time_s,id,x_m,y_m,vx_m_s,vy_m_s,radius_m,spin_rad_s,x_se_m,visible,confidence");
  for (const TrackPoint& p : m.tracks) {
    table.whole(p.frame)
        .digits(p.time, 9)
        .whole(p.id)
        .decimals(p.x, 7)
        .decimals(p.y, 7)
        .digits(p.vx, 6)
        .digits(p.vy, 6)
        .digits(p.radius, 6)
        .digits(p.spin, 6);
    if (film) table.decimals(p.u_px, 3).decimals(p.v_px, 3);
    table.digits(p.x_se, 3).decimals(p.visible, 3).decimals(p.confidence, 3);
    table.end_line();
  }
  table.finish();
}

void write_occupancy(const fs::path& path, const ChargeMotion& m) {
  Table table(path, "angle_deg,occupancy");
  for (std::size_t i = 0; i < m.ring_occupancy.size(); ++i)
    table.digits(static_cast<double>(i) + 0.5, 6).decimals(m.ring_occupancy[i], 6).end_line();
  table.finish();
}

void write_surface(const fs::path& path, const ChargeMotion& m) {
  Table table(path, "x_m,y_m,se_m");
  for (const SurfacePoint& p : m.surface) table.decimals(p.x, 6).decimals(p.y, 6).digits(p.se, 4).end_line();
  table.finish();
}

void write_torque(const fs::path& path, const ChargeMotion& m) {
  Table table(path, "time_s,torque_N_m,power_W");
  for (const TorqueRow& r : m.torque_series) table.digits(r.time, 9).digits(r.torque, 8).digits(r.power, 8).end_line();
  table.finish();
}

}  // namespace

std::string summary_json(const ChargeMotion& m) {
  Json s;
  s["source"] = name_of(m.source);
  s["origin"] = m.origin;
  s["rotation"] = m.rotation == Rotation::kUnknown ? Json(nullptr) : Json(name_of(m.rotation));
  for (const MotionQuantity& q : kMotionQuantities) {
    const std::string name = q.name;
    if (name == "centre_of_circulation_y_m") continue;
    if (name == "centre_of_circulation_x_m") {
      const Estimate &x = m.centre_of_circulation_x, &y = m.centre_of_circulation_y;
      s["centre_of_circulation_m"] = pair(number(x.value), number(y.value));
      s["centre_of_circulation_m_se"] = pair(error(x.se), error(y.se));
      continue;
    }
    put(s, name, (m.*q.of).value, (m.*q.of).se);
  }
  s["mill_centre_px"] = pair(number(m.camera.centre_u_px), number(m.camera.centre_v_px));
  s["mill_centre_px_se"] = pair(error(m.camera.centre_u_px_se), error(m.camera.centre_v_px_se));
  put(s, "mill_radius_px", m.camera.radius_px, m.camera.radius_px_se);
  put(s, "metres_per_pixel", m.camera.metres_per_pixel, m.camera.metres_per_pixel_se);
  put(s, "roll_deg", m.camera.roll_deg.value, m.camera.roll_deg.se);
  put(s, "k1", m.camera.k1.value, m.camera.k1.se);
  s["frames"] = m.frames;
  put(s, "frames_per_second", m.frames_per_second, m.frames_per_second_se);
  s["duplicated_frames"] = m.duplicated_frames;
  s["dropped_frames"] = m.dropped_frames;
  s["caveats"] = m.caveats;
  // A file's name need not be UTF-8; what is not becomes a replacement character rather than an exception.
  return s.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_csv(const fs::path& folder, const ChargeMotion& motion) {
  write_text(folder / "summary.json", summary_json(motion));
  write_profile(folder / "profile.csv", motion);
  write_tracks(folder / "tracks.csv", motion);
  write_occupancy(folder / "occupancy.csv", motion);
  write_surface(folder / "surface.csv", motion);
  if (motion.source == MotionSource::kRunFile) write_torque(folder / "torque.csv", motion);
}

}  // namespace tumble::io
