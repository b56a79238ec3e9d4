#include "analysis/film_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "analysis/film_reader.h"
#include "core/angle.h"

namespace tumble::analysis {
namespace {

constexpr int kShift = 4;        // fractional bits of OpenCV's drawing
constexpr int kTrail = 8;        // frames of a ball's way that are drawn
constexpr int kTileWidth = 640;  // of the contact sheet [px]
constexpr int kTiles = 6;
const cv::Scalar kMillColour(255, 200, 60), kToeColour(60, 90, 255), kShoulderColour(80, 220, 80),
    kRejectColour(60, 60, 230), kHiddenColour(200, 60, 200);

cv::Point fixed(const cv::Point2d& p) {
  return {static_cast<int>(std::lround(p.x * (1 << kShift))), static_cast<int>(std::lround(p.y * (1 << kShift)))};
}

void draw_line(cv::Mat& bgr, const cv::Point2d& a, const cv::Point2d& b, const cv::Scalar& colour, int width) {
  cv::line(bgr, fixed(a), fixed(b), colour, width, cv::LINE_AA, kShift);
}

cv::Scalar colour_of_track(int track) {
  // Neighbouring numbers far apart round the colour circle.
  const double hue = std::fmod(track * 137.508, 360.0) / 60;
  const auto part = [&](double at) {
    return 90 + 165 * std::clamp(std::abs(std::fmod(hue + at, 6.0) - 3) - 1, 0.0, 1.0);
  };
  return {part(2), part(4), part(0)};
}

class Pen {
 public:
  // What is written stays within `part` of the picture.
  Pen(cv::Mat& bgr, const FilmFindings& findings, const cv::Rect& part)
      : bgr_(bgr),
        findings_(findings),
        part_(part),
        width_(std::max(1, part.height / 480)),
        text_(part.height / 1000.0) {}

  cv::Point2d at(double share, double seen_angle) const {
    const double r = share * findings_.radius;
    return picture_of(findings_.camera, {r * std::cos(seen_angle), r * std::sin(seen_angle), 0});
  }
  double seen(double mill_deg) const {  // direction in the picture of one in the mill's own frame [rad]
    return radians(findings_.clockwise ? 180 - mill_deg : mill_deg) + findings_.roll;
  }

  void circle(double share, const cv::Scalar& colour) const {
    std::vector<cv::Point> points;
    for (int k = 0; k < 180; ++k) points.push_back(fixed(at(share, k * kPi / 90)));
    cv::polylines(bgr_, points, true, colour, width_, cv::LINE_AA, kShift);
  }
  void line(const cv::Point2d& a, const cv::Point2d& b, const cv::Scalar& colour, int times = 1) const {
    draw_line(bgr_, a, b, colour, times * width_);
  }
  void text(const std::string& words, const cv::Point2d& where, const cv::Scalar& colour) const {
    const cv::Point p(static_cast<int>(where.x), static_cast<int>(where.y));
    cv::putText(bgr_, words, p, cv::FONT_HERSHEY_SIMPLEX, text_, {0, 0, 0}, 2 * width_ + 1, cv::LINE_AA);
    cv::putText(bgr_, words, p, cv::FONT_HERSHEY_SIMPLEX, text_, colour, width_, cv::LINE_AA);
  }
  double text_size() const { return text_; }
  int width() const { return width_; }

  void edge(const char* name, const Estimate& angle, const cv::Scalar& colour) const {
    if (std::isnan(angle.value)) return;
    const double inner = findings_.tip_radius / findings_.radius, a = seen(angle.value);
    line(at(0.75 * inner, a), at(1.08, a), colour, 2);
    const std::string words = std::isnan(angle.se)
                                  ? fmt::format("{} {:.1f} deg", name, angle.value)
                                  : fmt::format("{} {:.1f} +- {:.1f} deg", name, angle.value, angle.se);
    const cv::Size size = cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, text_, width_, nullptr);
    cv::Point2d label = at(1.12, a);
    if (label.x < at(0, 0).x) label.x -= size.width;
    const double left = part_.x + 4, right = part_.x + part_.width - size.width - 6;
    label.x = std::clamp(label.x, left, std::max(left, right));
    label.y = std::clamp(label.y, part_.y + 60 * text_, part_.y + part_.height - 8.0);
    text(words, label, colour);
  }

 private:
  cv::Mat& bgr_;
  const FilmFindings& findings_;
  cv::Rect part_;
  int width_;
  double text_;
};

void draw_balls(cv::Mat& bgr, const FilmFindings& findings, std::size_t frame, int width) {
  std::map<int, cv::Point2d> ahead;  // where each ball is in the frame after
  for (std::size_t f = frame + 1; f-- > 0 && f + kTrail > frame;)
    for (const FoundBall& b : findings.balls[f]) {
      if (b.track < 0) {
        if (f != frame) continue;
        const double r = 0.4 * b.radius;
        draw_line(bgr, {b.u - r, b.v - r}, {b.u + r, b.v + r}, kRejectColour, width);
        draw_line(bgr, {b.u - r, b.v + r}, {b.u + r, b.v - r}, kRejectColour, width);
        continue;
      }
      const cv::Scalar colour = colour_of_track(b.track);
      if (f == frame) {
        cv::circle(bgr, fixed({b.u, b.v}), static_cast<int>(b.radius * (1 << kShift)), colour, width, cv::LINE_AA,
                   kShift);
        ahead[b.track] = {b.u, b.v};
      } else if (const auto next = ahead.find(b.track); next != ahead.end()) {
        draw_line(bgr, {b.u, b.v}, next->second, colour, width);
        next->second = {b.u, b.v};
      }
    }
}

void draw_hidden(cv::Mat& bgr, const cv::Mat& hidden) {
  if (hidden.empty() || hidden.size() != bgr.size()) return;
  for (int v = 0; v < bgr.rows; ++v)
    for (int u = 0; u < bgr.cols; ++u)
      if (hidden.at<std::uint8_t>(v, u) > 0 && (u + v) % 8 < 3)
        for (int c = 0; c < 3; ++c) bgr.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<std::uint8_t>(kHiddenColour[c]);
}

Image image_of(const cv::Mat& bgr) {
  Image image(bgr.cols, bgr.rows);
  cv::Mat rgba(bgr.rows, bgr.cols, CV_8UC4, image.rgba.data());
  cv::cvtColor(bgr, rgba, cv::COLOR_BGR2RGBA);
  return image;
}

std::string number(const char* name, const Estimate& e, const char* unit, int digits) {
  if (std::isnan(e.value)) return fmt::format("{} not told", name);
  if (std::isnan(e.se)) return fmt::format("{} {:.{}f}{}", name, e.value, digits, unit);
  return fmt::format("{} {:.{}f} +- {:.{}f}{}", name, e.value, digits, e.se, digits, unit);
}

// Circle, lifters, balls with the way they came, toe and shoulder, what is hidden and what was rejected, over a picture
// of the film; words stay within `part` of it.
void draw_within(cv::Mat& bgr, const cv::Rect& part, const FilmFindings& findings, const ChargeMotion& motion,
                 int frame) {
  const auto f = static_cast<std::size_t>(frame);
  if (f >= findings.balls.size()) return;
  draw_hidden(bgr, findings.hidden);
  const Pen pen(bgr, findings, part);
  draw_balls(bgr, findings, f, pen.width());
  const double tip = findings.tip_radius / findings.radius;
  pen.circle(1, kMillColour);
  if (tip < 1) {
    pen.circle(tip, 0.6 * kMillColour);
    for (int k = 0; k < findings.lifters && !std::isnan(findings.lifter_angle); ++k) {
      const double a = findings.lifter_angle + findings.drum[f] + 2 * kPi * k / findings.lifters;
      pen.line(pen.at(tip, a), pen.at(1, a), kMillColour);
    }
  }
  pen.line(pen.at(0.02, 0), pen.at(0.02, kPi), kMillColour);
  pen.line(pen.at(0.02, 0.5 * kPi), pen.at(0.02, 1.5 * kPi), kMillColour);
  pen.edge("toe", motion.toe_deg, kToeColour);
  pen.edge("shoulder", motion.shoulder_deg, kShoulderColour);
  const double time = f < motion.profile.size() ? motion.profile[f].time : kNotGiven;
  pen.text(std::isnan(time) ? fmt::format("frame {}", frame) : fmt::format("frame {}, {:.3f} s", frame, time),
           {part.x + 8.0, part.y + 26 * pen.text_size() + 4}, {255, 255, 255});
}

// The mill, four wide by three high.
cv::Rect mill_part(const FilmFindings& findings, cv::Size picture) {
  const cv::Point2d middle = picture_of(findings.camera, {0, 0, 0});
  double reach = 0;
  for (int k = 0; k < 8; ++k) {
    const double a = k * kPi / 4, r = 1.12 * findings.radius;
    const cv::Point2d p = picture_of(findings.camera, {r * std::cos(a), r * std::sin(a), 0}) - middle;
    reach = std::max(reach, std::hypot(p.x, p.y));
  }
  const cv::Rect part(static_cast<int>(middle.x - 4 * reach / 3), static_cast<int>(middle.y - reach),
                      static_cast<int>(8 * reach / 3), static_cast<int>(2 * reach));
  const cv::Rect whole({0, 0}, picture), seen = part & whole;
  return seen.area() > 0 ? seen : whole;
}

}  // namespace

void draw_film(const std::string& path, const FilmFindings& findings, const ChargeMotion& motion,
               const std::function<void(const Image&)>& sink, const Progress& progress) {
  FilmReader film(path);
  cv::Mat picture;
  for (int f = 0; f < motion.frames && film.next(picture); ++f) {
    draw_within(picture, {{0, 0}, picture.size()}, findings, motion, f);
    sink(image_of(picture(cv::Rect(0, 0, picture.cols / 2 * 2, picture.rows / 2 * 2))));
    report(progress, static_cast<double>(f + 1) / motion.frames);
  }
}

std::vector<int> sheet_frames(int frames) {
  std::vector<int> shown;
  for (int i = 0; i < kTiles && frames > 0; ++i) {
    const int frame = std::min(frames - 1, i * frames / kTiles + kTrail);
    if (shown.empty() || frame > shown.back()) shown.push_back(frame);
  }
  return shown;
}

Image contact_sheet(const std::string& path, const std::vector<int>& frames, const std::vector<cv::Mat>& pictures,
                    const FilmFindings& findings, const ChargeMotion& motion) {
  std::vector<cv::Mat> tiles;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    cv::Mat picture = pictures[i].clone();
    const cv::Rect part = mill_part(findings, picture.size());
    draw_within(picture, part, findings, motion, frames[i]);
    cv::Mat tile;
    cv::resize(picture(part), tile, {kTileWidth, std::max(1, kTileWidth * part.height / part.width)}, 0, 0,
               part.width > kTileWidth ? cv::INTER_AREA : cv::INTER_LINEAR);
    tiles.push_back(tile);
  }
  if (tiles.empty()) return {};
  const int height = tiles.front().rows, rows = (static_cast<int>(tiles.size()) + 2) / 3;
  const std::array<std::string, 3> numbers = {
      path,
      number("speed", motion.speed_rpm, " rev/min", 2) + ", " + name_of(motion.rotation) +
          fmt::format(", {:.4g} frames/s, {} repeated, {} gaps, ", motion.frames_per_second,
                      motion.duplicated_frames.size(), motion.dropped_frames.size()) +
          number("camera's roll", motion.camera.roll_deg, " deg", 2),
      number("toe", motion.toe_deg, " deg", 1) + ", " + number("shoulder", motion.shoulder_deg, " deg", 1) + ", " +
          number("filling", motion.filling, "", 3)};
  constexpr int kLine = 26;
  const int lines = static_cast<int>(numbers.size() + motion.caveats.size());
  cv::Mat sheet(rows * height + lines * kLine + 16, 3 * kTileWidth, CV_8UC3, cv::Scalar(28, 24, 22));
  for (std::size_t i = 0; i < tiles.size(); ++i)
    tiles[i].copyTo(
        sheet(cv::Rect(static_cast<int>(i % 3) * kTileWidth, static_cast<int>(i / 3) * height, kTileWidth, height)));
  int y = rows * height + kLine;
  const auto write = [&](const std::string& text, const cv::Scalar& colour) {
    cv::putText(sheet, text, {12, y}, cv::FONT_HERSHEY_SIMPLEX, 0.55, colour, 1, cv::LINE_AA);
    y += kLine;
  };
  for (const std::string& n : numbers) write(n, {235, 235, 235});
  for (const std::string& c : motion.caveats) write("note: " + c, {80, 190, 255});
  return image_of(sheet);
}

}  // namespace tumble::analysis
