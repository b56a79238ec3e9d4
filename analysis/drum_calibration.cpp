#include "analysis/drum_calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "analysis/drum_cover.h"
#include "analysis/drum_pose.h"
#include "analysis/drum_rings.h"
#include "analysis/drum_scale.h"
#include "analysis/drum_turn.h"
#include "analysis/even_turn.h"
#include "analysis/film_reader.h"
#include "core/error.h"
#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kMostFrames = 300;           // looked at
constexpr int kUsualWidth = 640;           // of pictures after reduction [px]: 300 of them are some 70 MB, never 150
constexpr std::size_t kTrialFrames = 150;  // of them, to choose between views
constexpr int kPoseFrames = 100;           // of them, for the camera
constexpr std::size_t kFewestFrames = 8, kFewestSightings = 400;
constexpr double kLeastTurn = 0.1;     // of the drum during the film, to tell what turns from what stands still [rad]
constexpr double kBorder = 10;         // within which an edge belongs to the textured surface [px]
constexpr double kRingAlike = 0.1;     // by which neighbours on an edge err alike [px]
constexpr double kSlightTilt = 0.04;   // below which the view is as good as frontal to begin with [rad]
constexpr double kUsualBall = 0.05;    // radius of a ball in shell radii, where neither is known
constexpr double kShellShare = 0.9;    // of the shell in what turns, roughly
constexpr double kClearTurn = 0.2;     // coherence of a ring whose turn is beyond doubt
constexpr double kRing = 0.7;          // of a disc's radius: from there on it is unrolled first
constexpr double kSameTurn = 0.2;      // by which the turn of two parts of one drum may be told apart
constexpr double kClearlyWider = 1.2;  // times by which another disc is larger
constexpr double kFrontShare = 0.7;    // of the rim's radius, outside of which marks are in the plane of the glass
constexpr double kRoughTurn = 0.02;    // by which first angles may be off [rad]
constexpr double kCovered = 1.7;       // times by which a piece looks less like itself than usual where balls cover it
constexpr double kEnough = 0.35;       // of the pieces of one band
constexpr double kClearTwist = 3;      // standard errors from which a picture is read out line by line
constexpr double kMarkHeight = 0.03;   // by which marks may lie before the inside of the glass, in shell radii
constexpr double kNoTwist = 0.005;     // readout that is as good as none [frame periods]
constexpr double kSameTilt = 0.05;     // between views that are one [rad]
constexpr double kClearMisfit = 0.1;   // between views, of which one is clearly better
constexpr double kFinestBlur = 0.7;    // [px]

struct Sample {
  std::vector<cv::Mat> greys;
  cv::Mat mean, deviation;
  cv::Mat coarse_deviation;  // of pictures of half the size, in which noise has averaged out; size as the others
  cv::Size film_size;
  int reduced = 1;
  double fps = kNotGiven;
};

Sample read_sample(const NextPicture& next, double frames_per_second, const Progress& progress) {
  Sample sample;
  sample.fps = frames_per_second;
  cv::Mat picture, sum, squares, half, half_sum, half_squares;
  while (static_cast<int>(sample.greys.size()) < kMostFrames && next(picture)) {
    sample.film_size = picture.size();
    sample.reduced = std::max(1, (picture.cols + kUsualWidth / 2) / kUsualWidth);
    cv::Mat grey = reduced_grey(picture, sample.reduced);
    if (sum.empty()) {
      sum = cv::Mat::zeros(grey.size(), CV_32F);
      squares = cv::Mat::zeros(grey.size(), CV_32F);
      half_sum = cv::Mat::zeros(grey.rows / 2, grey.cols / 2, CV_32F);
      half_squares = half_sum.clone();
    }
    cv::accumulate(grey, sum);
    cv::accumulateSquare(grey, squares);
    cv::resize(grey, half, half_sum.size(), 0, 0, cv::INTER_AREA);
    cv::accumulate(half, half_sum);
    cv::accumulateSquare(half, half_squares);
    sample.greys.push_back(grey);
    report(progress, 0.5 * static_cast<double>(sample.greys.size()) / kMostFrames);
  }
  if (sample.greys.empty()) return sample;
  const double n = static_cast<double>(sample.greys.size());
  const auto deviation = [&](const cv::Mat& total, const cv::Mat& total_squares) {
    const cv::Mat mean = total / n;
    cv::Mat variance = total_squares / n - mean.mul(mean);
    cv::sqrt(cv::max(variance, 0), variance);
    return variance;
  };
  sample.mean = sum / n;
  sample.deviation = deviation(sum, squares);
  cv::resize(deviation(half_sum, half_squares), sample.coarse_deviation, sample.mean.size(), 0, 0, cv::INTER_LINEAR);
  return sample;
}

bool is_clear(const RingEdgePoints& r) { return r.coverage > 0.6 && std::abs(r.strength) > 1.5; }

// Those that are circles as good as any: others are outlines before a changing ground, or lie deeper.
std::vector<RingSighting> sightings_of(const std::vector<RingEdgePoints>& rings) {
  double smoothest = 1e9;
  for (const RingEdgePoints& r : rings)
    if (is_clear(r)) smoothest = std::min(smoothest, r.roughness);
  std::vector<RingSighting> seen;
  for (const RingEdgePoints& r : rings)
    if (is_clear(r) && r.roughness < 2 * smoothest + 0.03)
      seen.push_back({r.points, r.radius,
                      std::max(kRingAlike, r.roughness) * std::sqrt(static_cast<double>(r.points.size()) / 12)});
  return seen;
}

// Views of the drum that the outlines in the mean picture allow: the frontal one, and the oblique ones that make
// circles of its ellipses. From the other side of the axis an ellipse looks nearly alike.
std::vector<DrumPose> likely_poses(const Sample& sample, const TurningDisc& disc, const PosePrior& prior) {
  std::vector<DrumPose> poses{frontal_pose(sample.mean.size(), disc.axis)};
  DrumPose best = poses[0];
  for (double reach : {0.035, 0.02, 0.012}) {
    DrumSightings seen;
    seen.rings = sightings_of(
        find_rings(sample.mean, best, 0.8 * disc.radius, 1.1 * disc.radius, std::max(2.0, reach * disc.radius)));
    if (seen.rings.empty()) return poses;
    double least = 1e300;
    DrumPose next = best;
    for (int start = 0; start < 5; ++start) {  // the slope towards a tilt vanishes at none
      DrumPose from = best;
      if (start < 4 && reach > 0.03) {
        from.numbers[DrumPose::kTiltX] = (start & 1) != 0 ? 0.1 : -0.1;
        from.numbers[DrumPose::kTiltY] = (start & 2) != 0 ? 0.1 : -0.1;
      } else if (start < 4) {
        continue;
      }
      const PoseFit fit = fit_pose(seen, from, {}, {}, prior);
      if (fit.cost >= least) continue;
      least = fit.cost;
      next = fit.pose;
    }
    best = next;
  }
  const double tilt = std::hypot(best.numbers[DrumPose::kTiltX], best.numbers[DrumPose::kTiltY]);
  if (tilt < kSlightTilt) return poses;
  DrumPose other = best;
  other.numbers[DrumPose::kTiltX] *= -1;
  other.numbers[DrumPose::kTiltY] *= -1;
  DrumSightings seen;
  seen.rings = sightings_of(
      find_rings(sample.mean, best, 0.8 * disc.radius, 1.1 * disc.radius, std::max(2.0, 0.012 * disc.radius)));
  other = fit_pose(seen, other, {}, {}, prior).pose;
  poses.push_back(best);
  poses.push_back(other);
  return poses;
}

// The drum's angles as far as a first view tells them.
DrumTurn first_turn(const Sample& sample, const DrumPose& pose, const PolarGrid& grid, double expected_step,
                    std::size_t most_pictures) {
  const Unroller unroll(pose, grid);
  std::vector<cv::Mat> strips;
  for (std::size_t t = 0; t < std::min(most_pictures, sample.greys.size()); ++t)
    strips.push_back(unroll(sample.greys[t]));
  const StillPart still = find_still_part(strips);
  const DrumTexture blank(unroll, still, 1.5);
  std::vector<RoundSpectrum> spectra;
  for (const cv::Mat& s : strips) spectra.emplace_back(blank.moving_part(s));
  cv::Mat in_view;
  cv::reduce(unroll.in_view(), in_view, 0, cv::REDUCE_AVG, CV_32F);
  return follow_turn(std::move(spectra), {in_view.begin<float>(), in_view.end<float>()}, expected_step);
}

double turned(const DrumTurn& turn) { return std::abs(turn.angles.back() - turn.angles.front()); }

// The part of a disc to be unrolled, from a share of its radius to somewhat beyond.
PolarGrid ring_grid(double radius, double inner) {
  PolarGrid grid;
  grid.inner = std::round(inner * radius);
  grid.rows = static_cast<int>(std::ceil((1.14 - inner) * radius / 6)) * 6;
  grid.columns = radius < 230 ? 1024 : 2048;
  return grid;
}

// The view in which most of a disc holds together as it turns.
struct FirstView {
  DrumTurn turn;
  DrumPose pose;
  PolarGrid grid;
  bool even = false;           // it turns as a drum does
  bool by_ring = false;        // told by the ring at the shell alone
  bool ring_misleads = false;  // the ring at the shell does not
};

bool is_clear(const FirstView& view) { return view.even && view.turn.coherence > kClearTurn; }

FirstView first_view(const Sample& sample, const TurningDisc& disc, double expected_step) {
  FirstView view;
  const auto poses = likely_poses(sample, disc, usual_camera(sample.mean.size(), disc.radius));
  for (const double inner : {kRing, 0.15}) {  // flange, shell and lifters; else marks on the back plate may tell
    const PolarGrid grid = ring_grid(disc.radius, inner);
    const bool ring_is_clear = view.turn.coherence > kClearTurn;
    for (const DrumPose& pose : poses) {
      DrumTurn seen = first_turn(sample, pose, grid, expected_step, poses.size() > 1 ? kTrialFrames : kMostFrames);
      const bool even = seen.found && turned(seen) >= kLeastTurn && evenness_of(seen.angles).even;
      // A charge that slides along the shell may hold together better than what little is seen of the drum.
      if (even != view.even ? !even : seen.coherence <= view.turn.coherence) continue;
      if (inner < kRing && !even && ring_is_clear)
        continue;  // neither is the drum: what is next to the shell is nearer
      view = {std::move(seen), pose, grid, even, inner == kRing, inner < kRing && ring_is_clear};
    }
    if (is_clear(view)) break;
  }
  if (view.turn.found && view.turn.angles.size() < sample.greys.size())
    view.turn = first_turn(sample, view.pose, view.grid, expected_step, kMostFrames);
  return view;
}

// Radius within which things turn with the drum.
double textured_reach(const Sample& sample, const DrumPose& pose, const PolarGrid& grid, const DrumTurn& turn) {
  std::vector<cv::Mat> greys;
  std::vector<double> angles;
  const std::size_t n = sample.greys.size(), every = std::max<std::size_t>(1, n / 60);
  for (std::size_t t = 0; t < n; t += every) {
    greys.push_back(sample.greys[t]);
    angles.push_back(turn.angles[t]);
  }
  const DrumReader reader(pose, grid, sample.reduced, greys, angles, 2.0, 0);
  double most = 0;
  for (int r = 0; r < grid.rows; ++r) most = std::max(most, reader.texture().coherence(r));
  int last = grid.rows - 1;
  while (last > 0 && reader.texture().coherence(last) < 0.3 * most) --last;
  return grid.radius(last + 1);
}

// Where the texture was found, and the edges that go round with it.
DrumSightings look(const DrumReader& reader, const std::vector<double>& angles, const cv::Mat& mean, int margin,
                   double reach, double rim) {
  DrumSightings seen;
  const DrumTexture& texture = reader.texture();
  double innermost = 1e9;
  for (int k = 0; k < texture.pieces(); ++k) {
    seen.pieces.push_back(texture.piece(k));
    if (seen.pieces.back().layer == 0) innermost = std::min(innermost, seen.pieces.back().radius);
  }
  if (seen.pieces.empty()) return seen;
  seen.layers = texture.surface(0) + 1;
  std::vector<std::vector<DrumTexture::Found>> found;
  for (std::size_t t = 0; t < angles.size(); ++t) found.push_back(texture.find(reader.moving()[t], angles[t]));
  std::size_t in_front = 0;
  for (int k = 0; k < texture.pieces(); ++k) {
    const auto piece = static_cast<std::size_t>(k);
    std::vector<double> rests;
    for (const auto& f : found)
      if (f[piece].seen) rests.push_back(f[piece].grey_deviation);
    if (rests.empty()) continue;
    const double clear = quantile_of(std::move(rests), 0.25);
    for (std::size_t t = 0; t < angles.size(); ++t) {
      const auto& f = found[t][piece];
      if (!f.seen || f.grey_deviation > kCovered * clear) continue;
      seen.sightings.push_back({static_cast<int>(t), k, texture.pixel_of(k, angles[t], f), f.weight});
      in_front += seen.pieces[piece].layer == 0;
    }
  }
  // Inside the shell the charge lies against whatever turns, always on the same side: the surface outside of it says
  // less that is wrong, where it says enough.
  if (static_cast<double>(in_front) > kEnough * static_cast<double>(angles.size()) * DrumTexture::kPieces)
    std::erase_if(seen.sightings,
                  [&](const PieceSighting& s) { return seen.pieces[static_cast<std::size_t>(s.piece)].layer > 0; });
  // The outermost surface is the plane z = 0, and the edges next to it are in it; but what lies far inside the rim is
  // on the back plate, at a depth of its own.
  const PolarGrid& grid = reader.unroll().grid();
  double from = innermost - margin - reach - kBorder;
  if (innermost < kFrontShare * rim) {
    for (DrumPiece& p : seen.pieces) ++p.layer;
    ++seen.layers;
    from = 0.8 * rim;
  }
  const auto rings = find_rings(mean, reader.unroll().pose(), from, grid.radius(grid.rows - 1), reach);
  seen.rings = sightings_of(rings);
  return seen;
}

struct Camera {
  bool found = false;
  bool ambiguous = false;  // the drum may be seen from the other side of its axis as well
  PoseFit fit;
  std::vector<std::size_t> frames;  // those whose angles the fit holds
};

// A view from the other side of the axis, read out otherwise, is nearly the same picture. Few marks in much noise leave
// it open.
void look_from_the_other_side(const DrumSightings& seen, const PosePrior& prior, Camera& camera) {
  DrumPose mirrored = camera.fit.pose;
  for (int p : {DrumPose::kTiltX, DrumPose::kTiltY}) mirrored.numbers[p] *= -1.5;
  mirrored.numbers[DrumPose::kTwist] = 0;
  PoseFit other = fit_pose(seen, mirrored, camera.fit.angles, camera.fit.depths, prior);
  const DrumPose::Numbers apart = other.pose.numbers - camera.fit.pose.numbers;
  if (std::hypot(apart[DrumPose::kTiltX], apart[DrumPose::kTiltY]) < kSameTilt) return;
  const double gain = camera.fit.misfit - other.misfit;
  if (gain > 0) camera.fit = std::move(other);
  if (std::abs(gain) > kClearMisfit) return;
  camera.ambiguous = true;
  camera.fit.covariance += apart * apart.transpose();
}

Camera fit_camera(const Sample& sample, const DrumPose& start, const PolarGrid& grid, const DrumTurn& turn, double rim,
                  PosePrior prior, const Progress& progress) {
  Camera camera;
  const std::size_t n = sample.greys.size(), count = std::min<std::size_t>(n, kPoseFrames);
  std::vector<cv::Mat> greys;
  camera.fit.pose = start;
  for (std::size_t i = 0; i < count; ++i) {
    camera.frames.push_back(i * n / count);
    greys.push_back(sample.greys[camera.frames.back()]);
    camera.fit.angles.push_back(turn.angles[camera.frames.back()]);
  }
  prior.deviation[DrumPose::kTwist] = 0.5 * std::abs(turn.step) + 1e-4;  // a picture is read out within its own time
  struct Stage {
    double blur;
    int margin;
    double reach;  // within which the edges of rings are looked for [px]
  };
  constexpr std::array<Stage, 6> kStages{
      {{3.0, 4, 4.0}, {2.0, 3, 2.5}, {1.2, 2, 2.0}, {0.7, 2, 1.5}, {0.7, 2, 1.5}, {0.7, 2, 1.5}}};
  double done = 0.5;
  DrumSightings last;
  for (const Stage& stage : kStages) {
    const DrumReader reader(camera.fit.pose, grid, sample.reduced, greys, camera.fit.angles, stage.blur, stage.margin);
    DrumSightings seen = look(reader, camera.fit.angles, sample.mean, stage.margin, stage.reach, rim);
    if (seen.sightings.size() < kFewestSightings) return camera;
    camera.fit = fit_pose(seen, camera.fit.pose, camera.fit.angles, camera.fit.depths, prior);
    report(progress, done += 0.06);
    last = std::move(seen);
  }
  look_from_the_other_side(last, prior, camera);
  // A readout that does not show is none: together with it, the axis would be free to slip sideways.
  const double error = std::sqrt(camera.fit.covariance(DrumPose::kTwist, DrumPose::kTwist));
  if (!camera.ambiguous && std::abs(camera.fit.pose.twist()) < kClearTwist * error) {
    DrumPose at_once = camera.fit.pose;
    at_once.numbers[DrumPose::kTwist] = 0;
    prior.deviation[DrumPose::kTwist] = kNoTwist * std::abs(turn.step);
    // That it is none is supposed, not seen: the errors are those of a readout that is free, and what the supposition
    // has moved the camera by, for a readout just too short to be clear is set aside as well.
    const auto covariance = camera.fit.covariance;
    const DrumPose::Numbers free = camera.fit.pose.numbers;
    camera.fit = fit_pose(last, at_once, camera.fit.angles, camera.fit.depths, prior);
    const DrumPose::Numbers moved = camera.fit.pose.numbers - free;
    camera.fit.covariance = covariance + moved * moved.transpose();
  }
  camera.found = true;
  return camera;
}

// Commonest turn from picture to picture: the slope of the angles against the number of such turns, which repeated and
// missing pictures make 0 or 2.
Estimate turn_per_frame(const std::vector<DrumAngle>& all, double step) {
  std::vector<double> count, angles;
  for (const DrumAngle& a : all) {
    const double turns = angles.empty() ? 0 : (a.angle - angles.back()) / step;
    if (std::isnan(a.error) || std::abs(turns - std::round(turns)) > 0.3) continue;  // not seen well
    count.push_back(angles.empty() ? 0 : count.back() + std::round(turns));
    angles.push_back(a.angle);
  }
  const double n = static_cast<double>(count.size());
  double mx = 0, my = 0, xx = 0, xy = 0;
  for (std::size_t t = 0; t < count.size(); ++t) {
    mx += count[t] / n;
    my += angles[t] / n;
  }
  for (std::size_t t = 0; t < count.size(); ++t) {
    xx += (count[t] - mx) * (count[t] - mx);
    xy += (count[t] - mx) * (angles[t] - my);
  }
  if (!(xx > 0)) return {step, kNotGiven};
  const double slope = xy / xx;
  double squares = 0, neighbours = 0, last = 0;
  for (std::size_t t = 0; t < count.size(); ++t) {
    const double rest = angles[t] - my - slope * (count[t] - mx);
    squares += rest * rest;
    if (t > 0) neighbours += rest * last;
    last = rest;
  }
  const double alike = std::clamp(squares > 0 ? neighbours / squares : 0.0, 0.0, 0.98);  // of neighbours
  return {slope, std::sqrt(squares / std::max(1.0, n - 2) / xx * (1 + alike) / (1 - alike))};
}

// RMS error of the places that pixels of the glass are given, at a given scale, from the camera's covariance.
double place_error(const PoseFit& fit, double shell) {
  const MillCamera camera = fit.pose.camera();
  std::vector<Eigen::Vector2d> places;
  std::vector<cv::Point2d> pixels;
  for (double r : {0.2, 0.5, 0.75, 0.95})
    for (int k = 0; k < 12; ++k) {
      places.emplace_back(r * shell * std::cos(k * kPi / 6), r * shell * std::sin(k * kPi / 6));
      pixels.push_back(picture_of(camera, {places.back().x(), places.back().y(), 0}));
    }
  const Eigen::Index n = static_cast<Eigen::Index>(places.size());
  Eigen::MatrixXd by(2 * n, static_cast<Eigen::Index>(DrumPose::kCount));
  for (int p = 0; p < DrumPose::kCount; ++p) {
    DrumPose moved = fit.pose;
    const double step = 0.1 * std::sqrt(fit.covariance(p, p));
    moved.numbers[p] += step;
    const MillCamera other = moved.camera();
    // Scale and turn are nobody's fault: the places move by what a similarity about the axis cannot undo.
    Eigen::VectorXd shift(2 * n);
    double along = 0, across = 0, total = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Eigen::Vector2d d = mill_place_at(other, pixels[k], 0) - places[k];
      shift.segment<2>(2 * i) = d;
      const double w = std::pow(places[k].norm() / shell, 8);  // the scale is set near the shell
      along += w * d.dot(places[k]);
      across += w * (places[k].x() * d.y() - places[k].y() * d.x());
      total += w * places[k].squaredNorm();
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector2d& x = places[static_cast<std::size_t>(i)];
      shift.segment<2>(2 * i) -= (along * x + across * Eigen::Vector2d(-x.y(), x.x())) / total;
    }
    by.col(p) = shift / step;
  }
  return std::sqrt((by * fit.covariance * by.transpose()).trace() / static_cast<double>(n));
}

double share_in_view(const MillCamera& camera, double radius) {
  constexpr int kDirections = 360;
  int seen = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double a = 2 * kPi * k / kDirections;
    const cv::Point2d p = picture_of(camera, {radius * std::cos(a), radius * std::sin(a), 0});
    seen += p.x >= 0 && p.y >= 0 && p.x < camera.width && p.y < camera.height;
  }
  return static_cast<double>(seen) / kDirections;
}

}  // namespace

DrumView calibrate_drum(const std::string& path, const Config& known, const Progress& progress) {
  FilmReader film(path);
  return calibrate_drum([&](cv::Mat& picture) { return film.next(picture); }, film.frames_per_second(), known,
                        progress);
}

DrumView calibrate_drum(const NextPicture& next, double frames_per_second, const Config& known,
                        const Progress& progress) {
  DrumView view;
  const Sample sample = read_sample(next, frames_per_second, progress);
  const auto refuse = [&](const std::string& why) {
    view.found = false;
    view.caveats.push_back(why);
    return view;
  };
  if (sample.greys.size() < kFewestFrames)
    return refuse(
        fmt::format("{} pictures are too few to see a drum turn, at least {} were expected; single pictures are "
                    "taken from a folder",
                    sample.greys.size(), kFewestFrames));
  TurningDisc disc = find_turning_disc(sample.mean, sample.coarse_deviation);
  if (!disc.found) return refuse("no turning drum was found in the film");
  const double expected = speed_rpm(known.mill) * 2 * kPi / 60 / sample.fps;
  FirstView first = first_view(sample, disc, expected);
  // A drum that is mostly out of the picture: what is whole in it turns with what is round it, or is none.
  if (disc.wider > kClearlyWider * disc.radius) {
    TurningDisc wide = disc;
    wide.radius = disc.wider;
    wide.moving_besides = 0;
    FirstView wider = first_view(sample, wide, expected);
    const bool turns_with_it = wider.by_ring && std::abs(turned(wider.turn) / turned(first.turn) - 1) < kSameTurn;
    if (is_clear(wider) && (turns_with_it || !is_clear(first))) {
      disc = wide;
      first = std::move(wider);
    }
  }
  DrumTurn& turn = first.turn;
  const DrumPose& start = first.pose;
  PolarGrid& grid = first.grid;
  const PosePrior prior = usual_camera(sample.mean.size(), disc.radius);
  if (!turn.found || (!first.even && turn.coherence < kClearTurn))
    return refuse("nothing in the film turns evenly about a common axis");
  if (turned(turn) < kLeastTurn) return refuse("the drum hardly turns while it is filmed");
  // Other things move too: the drum reaches as far as anything turns with it.
  const double reach = textured_reach(sample, start, grid, turn);
  if (reach < 0.92 * disc.radius) disc.radius = reach;
  if (reach > kFrontShare * disc.radius && !first.ring_misleads) grid = ring_grid(disc.radius, kRing);
  const Camera camera = fit_camera(sample, start, grid, turn, disc.radius, prior, progress);
  if (!camera.found) return refuse("too little of the drum shows marks that turn with it");
  const DrumPose& pose = camera.fit.pose;

  // The drum's angle in every picture, by what the fitted camera and angles show of it.
  std::vector<cv::Mat> greys;
  for (std::size_t i : camera.frames) greys.push_back(sample.greys[i]);
  auto reader = std::make_shared<DrumReader>(pose, grid, sample.reduced, greys, camera.fit.angles, kFinestBlur, 2);
  std::vector<double> offsets;  // of the fitted angles from the first ones
  for (std::size_t i = 0; i < camera.frames.size(); ++i)
    offsets.push_back(camera.fit.angles[i] - turn.angles[camera.frames[i]]);
  const double offset = median_of(std::move(offsets));
  for (std::size_t t = 0; t < sample.greys.size(); ++t)
    view.angles.push_back(reader->angle_near(reader->unroll()(sample.greys[t]), turn.angles[t] + offset, kRoughTurn));
  view.turn_per_frame = turn_per_frame(view.angles, turn.step);
  view.readout = {pose.twist() / turn.step,
                  std::sqrt(camera.fit.covariance(DrumPose::kTwist, DrumPose::kTwist)) / std::abs(turn.step)};

  // Scale: which circle is the shell.
  const auto rings = find_rings(sample.mean, pose, grid.inner, grid.radius(grid.rows - 1), 1.5);
  const double mill_radius = 0.5 * known.mill.diameter;
  double ball = kNotGiven;
  for (const BallClass& c : known.charge.balls)
    if (c.radius > 0 && !(c.radius > ball)) ball = c.radius;
  const MillCamera pixels = pose.camera();
  const double ball_share = ball / mill_radius > 0 ? ball / mill_radius : kUsualBall;
  ShellGuess shell = find_shell(*reader, rings, ball_share * kShellShare * disc.radius);
  view.scale_from = shell.on_ring ? RingKind::kShell : RingKind::kUnknown;
  if (shell.radius == 0) {
    // No charge to be seen: the innermost edge of the textured surface, if it has one.
    const RingEdgePoints* bore = nullptr;
    for (const RingEdgePoints& r : rings)
      if (r.coverage > 0.6 && (bore == nullptr || std::abs(r.strength) > std::abs(bore->strength))) bore = &r;
    shell.radius = bore != nullptr ? bore->radius : 0.87 * disc.radius;
    shell.deviation = bore != nullptr ? 0.04 : 0.1;
    view.scale_from = bore != nullptr ? RingKind::kBore : RingKind::kOuterRim;
    view.caveats.push_back(
        "no charge was seen to reach the shell: the scale is a guess from the strongest edge round the drum");
  }
  const double unit = (mill_radius > 0 ? mill_radius : 1.0) / shell.radius;  // of a pixel at the origin
  view.scale = {1.0, shell.deviation};
  view.camera = with_lengths_times(for_enlarged_pictures(pixels, sample.reduced), unit);
  view.camera.width = sample.film_size.width;
  view.camera.height = sample.film_size.height;
  view.place_error = unit * place_error(camera.fit, shell.radius);
  for (const RingEdgePoints& r : rings)
    view.rings.push_back({r.radius * unit, r.strength, r.coverage, RingKind::kUnknown});

  const auto error = [&](int p) { return std::sqrt(camera.fit.covariance(p, p)); };
  view.focal = {view.camera.focal, view.camera.focal * error(DrumPose::kLogFocal)};
  view.k1 = {view.camera.k1, error(DrumPose::kK1)};
  const cv::Point2d axis = picture_of(view.camera, Eigen::Vector3d::Zero());
  const auto sum_error = [&](int p, int q) {
    return sample.reduced * std::sqrt(std::max(0.0, camera.fit.covariance(p, p) + camera.fit.covariance(q, q) +
                                                        2 * camera.fit.covariance(p, q)));
  };
  // Marks on a flange before the glass show the axis where it pierces their own plane.
  const double height = kMarkHeight * unit * shell.radius;
  const cv::Point2d ahead = picture_of(view.camera, {0, 0, height}) - axis;
  view.centre_u = {axis.x, std::hypot(sum_error(DrumPose::kOriginU, DrumPose::kCentreU), ahead.x)};
  view.centre_v = {axis.y, std::hypot(sum_error(DrumPose::kOriginV, DrumPose::kCentreV), ahead.y)};
  view.place_error = std::hypot(view.place_error, height * std::tan(obliqueness(view.camera)));
  view.obliqueness = {obliqueness(view.camera), std::hypot(error(DrumPose::kTiltX), error(DrumPose::kTiltY))};

  view.in_view = share_in_view(view.camera, unit * shell.radius);

  const double tip = known.mill.lifters.height > 0 && mill_radius > 0
                         ? shell.radius * (1 - known.mill.lifters.height / mill_radius)
                         : 0.93 * shell.radius;
  const int seen_lifters = view.lifters_seen = count_lifters(*reader, tip, 0.99 * shell.radius);
  view.lifter_count = known.mill.lifters.count > 0 ? known.mill.lifters.count : seen_lifters;
  // Every second lifter alike is seen as half as many.
  if (seen_lifters > 0 && seen_lifters % view.lifter_count != 0 && view.lifter_count % seen_lifters != 0)
    view.caveats.push_back(
        fmt::format("the drawing has {} lifters, but {} go round in the film: check mill.lifters.count",
                    view.lifter_count, seen_lifters));
  view.lifter_angle = lifter_angle(*reader, reader->strips(), camera.fit.angles, view.lifter_count, tip, shell.radius);
  const cv::Mat hidden = hidden_part(sample.mean, sample.deviation, pose, tip, shell.radius);
  const double deep = ball > 0 && mill_radius > 0 ? 2 * ball / mill_radius * shell.radius : 0.1 * shell.radius;
  view.hidden_share = hidden_share(hidden, pose, tip - deep, tip);
  cv::resize(hidden, view.hidden, sample.film_size, 0, 0, cv::INTER_NEAREST);
  reader->forget_pictures();
  view.reader = reader;
  if (camera.ambiguous)
    view.caveats.push_back("too few marks turn with the drum to tell from which side of the axis it is filmed");
  if (disc.moving_besides > 0.5)
    view.caveats.push_back("much moves outside of the drum: if the film shows two mills, crop it to one");
  view.found = true;
  report(progress, 1);
  return view;
}

}  // namespace tumble::analysis
