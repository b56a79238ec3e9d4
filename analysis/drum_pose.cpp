#include "analysis/drum_pose.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

using Eigen::Index;
using Numbers = DrumPose::Numbers;

constexpr int kPose = DrumPose::kCount;
constexpr int kPasses = 2, kRounds = 10;
constexpr double kSettled = 1e-3;  // of the cost
constexpr double kHuge = 4;        // chi2 beyond which a sighting loses its say (Cauchy)

constexpr int kDirections = 12;           // round the axis, in which sightings err alike
constexpr double kAlike = 0.1;            // by so much at least [px]
constexpr double kLightShift = 0.2;       // of the whole texture against what it is on [px]
constexpr std::size_t kFewSightings = 8;  // of a piece
// Of a piece's place against its rough one [px]: along the radius next to nothing, for all pieces may lie further out
// together where distortion says so; across it fixes the turn that pieces and angles share.
constexpr double kAlongRadius = 100, kAcrossRadius = 3;

// A step of each number that moves the picture by some hundredths of a pixel.
Numbers small_steps(double reach) {
  Numbers s;
  s << 0.01, 0.01, 1e-4, 1e-4, 1e-3, 1e-3, 0.05, 0.05, 0.01 / reach;
  return s;
}

}  // namespace

MillCamera DrumPose::camera() const {
  MillCamera c;
  c.focal = std::exp(numbers[kLogFocal]);
  c.centre_u = numbers[kCentreU];
  c.centre_v = numbers[kCentreV];
  c.k1 = numbers[kK1];
  c.rotation = (Eigen::AngleAxisd(numbers[kTiltX], Eigen::Vector3d::UnitX()) *
                Eigen::AngleAxisd(numbers[kTiltY], Eigen::Vector3d::UnitY()))
                   .toRotationMatrix() *
               MillCamera::frontal();
  c.translation = Eigen::Vector3d(numbers[kOriginU], numbers[kOriginV], c.focal);
  c.width = picture.width;
  c.height = picture.height;
  return c;
}

cv::Point2d DrumPose::picture_of(const MillCamera& c, double radius, double angle, double z) const {
  const auto at = [&](double a) { return analysis::picture_of(c, {radius * std::cos(a), radius * std::sin(a), z}); };
  cv::Point2d pixel = at(angle);
  if (twist() == 0) return pixel;
  for (int i = 0; i < 3; ++i) pixel = at(angle + turn_at(pixel.y));  // the row decides when it is seen
  return pixel;
}

DrumPose frontal_pose(cv::Size picture, const cv::Point2d& axis) {
  DrumPose pose;
  pose.picture = picture;
  pose.numbers[DrumPose::kLogFocal] = std::log(1.2 * picture.width);
  pose.numbers[DrumPose::kCentreU] = 0.5 * (picture.width - 1);
  pose.numbers[DrumPose::kCentreV] = 0.5 * (picture.height - 1);
  pose.numbers[DrumPose::kOriginU] = axis.x - pose.numbers[DrumPose::kCentreU];
  pose.numbers[DrumPose::kOriginV] = axis.y - pose.numbers[DrumPose::kCentreV];
  return pose;
}

PosePrior usual_camera(cv::Size picture, double drum_radius) {
  PosePrior prior;
  prior.mean = frontal_pose(picture, {0.5 * (picture.width - 1), 0.5 * (picture.height - 1)}).numbers;
  const double w = picture.width;
  prior.deviation << w, w, 0.2, 0.2, 0.4, 0.1, 0.02 * w, 0.02 * w, 0.1;
  prior.depth_deviation = 0.2 * drum_radius;
  return prior;
}

namespace {

// All unknowns. The first ones are solved for together: pose, light shift, depths, angles, rings; the pieces' places
// (radius, way along it) follow from them one by one.
struct State {
  DrumPose pose;
  Eigen::Vector2d light = Eigen::Vector2d::Zero();  // by which light moves the whole texture, along u and v [px]
  std::vector<double> depths, angles, rings;
  std::vector<Eigen::Vector2d> pieces;
};

struct Eliminated {  // a piece's block of the normal equations
  Eigen::Matrix2d inverse;
  Eigen::Vector2d right;
  Eigen::Matrix<double, Eigen::Dynamic, 2> cross;
};

struct Equations {
  Eigen::MatrixXd normal;  // read above the diagonal
  Eigen::VectorXd right;
  std::vector<Eliminated> pieces;
  double cost = 0;
};

class Adjustment {
 public:
  Adjustment(const DrumSightings& seen, const PosePrior& prior, std::size_t frames)
      : seen_(seen),
        prior_(prior),
        of_depths_(of_light_ + 2),
        of_angles_(of_depths_ + seen.layers - 1),
        of_rings_(of_angles_ + static_cast<Index>(frames)),
        unknowns_(of_rings_ + static_cast<Index>(seen.rings.size())) {
    sigma2_.assign(seen.pieces.size(), 1.0);
    say_.assign(static_cast<std::size_t>(seen.layers), 1.0);
    of_piece_.resize(seen.pieces.size());
    for (std::size_t i = 0; i < seen.sightings.size(); ++i)
      of_piece_[static_cast<std::size_t>(seen.sightings[i].piece)].push_back(i);
    double reach = 1;
    for (const DrumPiece& p : seen.pieces) reach = std::max(reach, p.radius);
    for (const RingSighting& r : seen.rings) reach = std::max(reach, r.radius);
    steps_ = small_steps(reach);
  }

  Index unknowns() const { return unknowns_; }
  double misfit() const {
    double sum = 0, count = 0;
    for (double s : sigma2_)
      if (!std::isnan(s)) {
        sum += std::log(s);
        ++count;
      }
    return count > 0 ? sum / count : 0;
  }
  // How far off a piece's typical sighting is, in its own standard errors: bolts, whose light and shade stay where they
  // are while they pass, more than rust. And how much say the sightings of a layer have.
  // By how much they err alike in one direction shows once the pose is fitted.
  void weigh(const State& s, bool fitted) {
    const MillCamera camera = s.pose.camera();
    std::vector<double> total(say_.size(), 0.0);
    using Means = std::array<Eigen::Vector3d, kDirections>;  // sums of misses and their number, by direction
    std::vector<Means> alike(say_.size());
    for (Means& m : alike) m.fill(Eigen::Vector3d::Zero());
    for (std::size_t k = 0; k < of_piece_.size(); ++k) {
      std::vector<double> chi2;
      double weights = 0;
      for (std::size_t i : of_piece_[k]) {
        const PieceSighting& sighting = seen_.sightings[i];
        const Aspect at = aspect(s, camera, sighting);
        chi2.push_back(at.miss.dot(sighting.weight * at.miss));
        weights += 0.5 * sighting.weight.trace();
        const double turn = std::atan2(at.si, at.co) / (2 * kPi) + 1;
        Eigen::Vector3d& mean = alike[static_cast<std::size_t>(seen_.pieces[k].layer)]
                                     [static_cast<std::size_t>(turn * kDirections) % kDirections];
        if (at.miss.squaredNorm() < 4) mean += Eigen::Vector3d(at.miss.x(), at.miss.y(), 1);
      }
      if (chi2.size() < kFewSightings) {
        sigma2_[k] = kNotGiven;
        continue;
      }
      sigma2_[k] = std::max(1.0, median_of(std::move(chi2)) / 1.386);  // the median of chi2 with two degrees of freedom
      total[static_cast<std::size_t>(seen_.pieces[k].layer)] += weights / sigma2_[k];
    }
    for (std::size_t l = 0; l < say_.size(); ++l) {
      double squares = 0, seen = 0;
      for (const Eigen::Vector3d& m : alike[l]) {
        if (m.z() < 5) continue;
        squares += m.head<2>().squaredNorm() / (m.z() * m.z());
        seen += 2;
      }
      const double left = fitted ? squares / std::max(1.0, seen - kPose) : 0;
      say_[l] = 1 / (1 + total[l] / kDirections * std::max(left, kAlike * kAlike));
    }
  }

  Equations equations(const State& s) const {
    Equations e;
    e.normal = Eigen::MatrixXd::Zero(unknowns_, unknowns_);
    e.right = Eigen::VectorXd::Zero(unknowns_);
    e.pieces.resize(seen_.pieces.size());
    std::array<MillCamera, kPose + 1> cameras;
    cameras[0] = s.pose.camera();
    for (int p = 0; p < kPose; ++p) {
      DrumPose moved = s.pose;
      moved.numbers[p] += steps_[p];
      cameras[static_cast<std::size_t>(p) + 1] = moved.camera();
    }
    add_priors(s, e);
    for (std::size_t k = 0; k < seen_.pieces.size(); ++k) add_piece(s, cameras, k, e);
    for (std::size_t r = 0; r < seen_.rings.size(); ++r) add_ring(s, cameras, r, e);
    for (const Eliminated& p : e.pieces) {
      if (p.cross.rows() == 0) continue;
      const Eigen::Matrix<double, Eigen::Dynamic, 2> c = p.cross * p.inverse;
      e.normal.noalias() -= c * p.cross.transpose();
      e.right.noalias() -= c * p.right;
    }
    return e;
  }

  State moved(const State& s, const Equations& e, double damping) const {
    Eigen::MatrixXd damped = e.normal.selfadjointView<Eigen::Upper>();
    damped.diagonal() *= 1 + damping;
    const Eigen::VectorXd step = damped.ldlt().solve(e.right);
    State next = s;
    next.pose.numbers += step.head<kPose>();
    next.light += step.segment<2>(of_light_);
    for (std::size_t l = 1; l < s.depths.size(); ++l) next.depths[l] += step[of_depths_ + static_cast<Index>(l) - 1];
    for (std::size_t t = 0; t < s.angles.size(); ++t) next.angles[t] += step[of_angles_ + static_cast<Index>(t)];
    for (std::size_t r = 0; r < s.rings.size(); ++r) next.rings[r] += step[of_rings_ + static_cast<Index>(r)];
    for (std::size_t k = 0; k < s.pieces.size(); ++k) {
      const Eliminated& p = e.pieces[k];
      if (p.cross.rows() > 0) next.pieces[k] += p.inverse * (p.right - p.cross.transpose() * step);
    }
    return next;
  }

 private:
  struct Aspect {  // of one sighting: directions are along the radius and across it, as the picture shows them
    Eigen::Vector3d place;
    double co, si, row;
    cv::Point2d here;
    Eigen::Vector2d miss;  // seen - expected

    Eigen::Vector2d polar(const cv::Point2d& d) const { return {d.x * co - d.y * si, -d.x * si - d.y * co}; }
  };

  Aspect aspect(const State& s, const MillCamera& camera, const PieceSighting& sighting) const {
    Aspect at;
    const auto k = static_cast<std::size_t>(sighting.piece);
    const DrumPiece& rough = seen_.pieces[k];
    at.row = (sighting.pixel.y + 0.5) / s.pose.picture.height - 0.5;
    const double theta = rough.angle + s.pieces[k][1] / rough.radius +
                         s.angles[static_cast<std::size_t>(sighting.frame)] + s.pose.twist() * at.row;
    at.co = std::cos(theta);
    at.si = std::sin(theta);
    at.place = {s.pieces[k][0] * at.co, s.pieces[k][0] * at.si, s.depths[static_cast<std::size_t>(rough.layer)]};
    at.here = picture_of(camera, at.place);
    at.miss = at.polar(sighting.pixel - at.here - cv::Point2d(s.light[0], s.light[1]));
    return at;
  }

  void add_priors(const State& s, Equations& e) const {
    const auto add = [&](Index i, double miss, double deviation) {
      const double w = 1 / (deviation * deviation);
      e.normal(i, i) += w;
      e.right[i] -= w * miss;
      e.cost += w * miss * miss;
    };
    for (int p = 0; p < kPose; ++p) add(p, s.pose.numbers[p] - prior_.mean[p], prior_.deviation[p]);
    for (int i = 0; i < 2; ++i) add(of_light_ + i, s.light[i], kLightShift);
    for (std::size_t l = 1; l < s.depths.size(); ++l)
      add(of_depths_ + static_cast<Index>(l) - 1, s.depths[l], prior_.depth_deviation);
    if (!s.angles.empty()) add(of_angles_, 0, 1e-3);  // the drum's zero is the first picture's
  }

  void add_piece(const State& s, const std::array<MillCamera, kPose + 1>& cameras, std::size_t k, Equations& e) const {
    if (std::isnan(sigma2_[k]) || of_piece_[k].empty()) return;
    const DrumPiece& rough = seen_.pieces[k];
    const double sigma2 = sigma2_[k], say = say_[static_cast<std::size_t>(rough.layer)];
    const Eigen::Vector2d off(s.pieces[k][0] - rough.radius, s.pieces[k][1]);
    Eigen::Matrix2d c =
        Eigen::Vector2d(1 / (kAlongRadius * kAlongRadius), 1 / (kAcrossRadius * kAcrossRadius)).asDiagonal();
    Eigen::Vector2d d = -c * off;
    e.cost += off.dot(c * off);
    Eigen::Matrix<double, Eigen::Dynamic, 2> cross = Eigen::MatrixXd::Zero(unknowns_, 2);
    constexpr double kStep = 1e-2;
    // Columns: pose, light, angle, depth.
    constexpr int kOwn = kPose + 4;
    Eigen::Matrix<double, 2, kOwn> j;
    std::array<Index, kOwn> at_index;
    for (int i = 0; i < kPose + 2; ++i) at_index[static_cast<std::size_t>(i)] = i;
    const int own = rough.layer > 0 ? kOwn : kOwn - 1;
    if (rough.layer > 0) at_index[kOwn - 1] = of_depths_ + rough.layer - 1;
    for (std::size_t i : of_piece_[k]) {
      const PieceSighting& sighting = seen_.sightings[i];
      const Aspect at = aspect(s, cameras[0], sighting);
      const double chi2 = at.miss.dot(sighting.weight * at.miss) / sigma2;
      e.cost += say * kHuge * std::log1p(chi2 / kHuge);
      const Eigen::Matrix2d w = sighting.weight * (say / sigma2 / (1 + chi2 / kHuge));
      const auto by = [&](const Eigen::Vector3d& direction) -> Eigen::Vector2d {
        return at.polar(picture_of(cameras[0], at.place + kStep * direction) - at.here) / kStep;
      };
      for (int p = 0; p < kPose; ++p)
        j.col(p) = at.polar(picture_of(cameras[static_cast<std::size_t>(p) + 1], at.place) - at.here) / steps_[p];
      const Eigen::Vector2d by_turn = by({-at.si, at.co, 0}) * s.pieces[k][0];
      j.col(DrumPose::kTwist) = by_turn * at.row;
      j.col(kPose) = at.polar({1, 0});
      j.col(kPose + 1) = at.polar({0, 1});
      j.col(kPose + 2) = by_turn;
      at_index[kPose + 2] = of_angles_ + sighting.frame;
      if (rough.layer > 0) j.col(kOwn - 1) = by({0, 0, 1});
      Eigen::Matrix2d jk;
      jk.col(0) = by({at.co, at.si, 0});
      jk.col(1) = by_turn / rough.radius;
      const Eigen::Matrix<double, kOwn, 2> jw = j.transpose() * w;
      const Eigen::Matrix2d kw = jk.transpose() * w;
      for (int p = 0; p < own; ++p) {
        const Index row = at_index[static_cast<std::size_t>(p)];
        for (int q = 0; q < own; ++q) {
          const Index column = at_index[static_cast<std::size_t>(q)];
          if (row <= column) e.normal(row, column) += jw.row(p).dot(j.col(q));
        }
        e.right[row] += jw.row(p).dot(at.miss);
        cross.row(row) += jw.row(p) * jk;
      }
      c += kw * jk;
      d += kw * at.miss;
    }
    e.pieces[k] = {c.inverse(), d, cross};
  }

  void add_ring(const State& s, const std::array<MillCamera, kPose + 1>& cameras, std::size_t r, Equations& e) const {
    const RingSighting& ring = seen_.rings[r];
    const Index at = of_rings_ + static_cast<Index>(r);
    e.normal(at, at) += 1e-9;
    for (const cv::Point2d& point : ring.points) {
      const double rho = mill_place_at(cameras[0], point, 0).norm(), miss = s.rings[r] - rho;
      if (std::isnan(rho)) continue;
      const double chi2 = miss * miss / (ring.deviation * ring.deviation);
      e.cost += kHuge * std::log1p(chi2 / kHuge);
      const double w = 1 / (ring.deviation * ring.deviation) / (1 + chi2 / kHuge);
      Numbers j = Numbers::Zero();
      for (int p = 0; p < kPose; ++p)
        if (p != DrumPose::kTwist)
          j[p] = (mill_place_at(cameras[static_cast<std::size_t>(p) + 1], point, 0).norm() - rho) / steps_[p];
      e.normal.topLeftCorner<kPose, kPose>() += w * j * j.transpose();
      e.right.head<kPose>() += w * miss * j;
      e.normal.block<kPose, 1>(0, at) -= w * j;
      e.normal(at, at) += w;
      e.right[at] -= w * miss;
    }
  }

  const DrumSightings& seen_;
  const PosePrior& prior_;
  static constexpr Index of_light_ = kPose;
  Index of_depths_, of_angles_, of_rings_, unknowns_;
  std::vector<double> sigma2_;  // chi2 of a typical sighting, by piece; NaN where there are too few
  std::vector<double> say_;     // of a sighting, by layer: many that err alike are not many witnesses
  std::vector<std::vector<std::size_t>> of_piece_;
  Numbers steps_;
};

}  // namespace

PoseFit fit_pose(const DrumSightings& seen, const DrumPose& start, const std::vector<double>& angles,
                 const std::vector<double>& depths, const PosePrior& prior) {
  State state;
  state.pose = start;
  state.angles = angles;
  state.depths = depths;
  state.depths.resize(static_cast<std::size_t>(seen.layers), 0.0);
  for (const DrumPiece& p : seen.pieces) state.pieces.push_back({p.radius, 0});
  for (const RingSighting& r : seen.rings) state.rings.push_back(r.radius);
  Adjustment adjustment(seen, prior, angles.size());
  Equations equations;
  for (int pass = 0; pass < kPasses; ++pass) {  // weights anew, once the pose is better
    adjustment.weigh(state, pass > 0);
    equations = adjustment.equations(state);
    double damping = 1e-4;
    for (int round = 0; round < kRounds && damping < 1e4; ++round) {
      const State next = adjustment.moved(state, equations, damping);
      Equations there = adjustment.equations(next);
      if (!(there.cost < equations.cost)) {
        damping *= 30;
        continue;
      }
      const double gain = equations.cost - there.cost;
      state = next;
      equations = std::move(there);
      damping = std::max(1e-8, 0.1 * damping);
      if (gain < kSettled) break;
    }
  }
  adjustment.weigh(state, true);
  equations = adjustment.equations(state);
  PoseFit fit;
  fit.pose = state.pose;
  fit.light_shift = state.light;
  fit.angles = state.angles;
  fit.depths = state.depths;
  fit.ring_radii = state.rings;
  const Eigen::MatrixXd normal = equations.normal.selfadjointView<Eigen::Upper>();
  fit.covariance = normal.ldlt().solve(Eigen::MatrixXd::Identity(adjustment.unknowns(), kPose)).topRows<kPose>();
  fit.cost = equations.cost;
  fit.misfit = adjustment.misfit();
  return fit;
}

}  // namespace tumble::analysis
