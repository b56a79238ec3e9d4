#include "diagnose/restitution.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "diagnose/student.h"
#include "sim/laws/linear_spring_dashpot.h"

namespace tumble::diagnose {
namespace {

constexpr double kSteel = 7800;  // [kg/m3], to compare sizes of balls whose mass alone is given

double variance_of(const Estimate& e) { return std::isfinite(e.se) ? e.se * e.se : 0.0; }

// Paule & Mandel: the variance between the values is what makes chi^2 of the weighted mean equal to n - 1.
struct Mean {
  Estimate mean;
  double between = 0;
};
Mean weighted_mean(std::span<const Estimate> values) {
  const double n = static_cast<double>(values.size());
  double between = 0, mean = 0, weights = 0;
  const auto chi2 = [&] {
    mean = weights = 0;
    for (const Estimate& e : values) {
      const double w = 1 / (variance_of(e) + between);
      mean += w * e.value;
      weights += w;
    }
    mean /= weights;
    double sum = 0;
    for (const Estimate& e : values) sum += (e.value - mean) * (e.value - mean) / (variance_of(e) + between);
    return sum;
  };
  if (values.size() == 1) return {values.front(), 0};
  double plain = 0, scatter = 0;
  for (const Estimate& e : values) plain += e.value / n;
  for (const Estimate& e : values) scatter += (e.value - plain) * (e.value - plain);
  const bool known = std::all_of(values.begin(), values.end(), [](const Estimate& e) { return variance_of(e) > 0; });
  if (!(scatter > 0) && !known) return {{plain, 0}, 0};
  // With no more scatter than their own errors, these alone; between the two, bisection of a falling function.
  double low = known ? 0 : 1e-12 * scatter, high = scatter;
  between = low;
  if (chi2() > n - 1) {
    for (int i = 0; i < 200 && high - low > 1e-12 * high; ++i) {
      between = (low + high) / 2;
      (chi2() > n - 1 ? low : high) = between;
    }
  }
  chi2();
  return {{mean, std::sqrt(1 / weights)}, between};
}

// How far the groups' means lie from the common one, beyond what impacts of one kind would scatter: the root of the
// mean square between groups, in the weights of the common mean; at least 1 (Birge 1932).
double birge_ratio(const Mean& all, std::span<const std::vector<Estimate>> groups) {
  if (groups.size() < 2 || !(all.mean.se > 0)) return 1;
  double between = 0;
  for (const auto& group : groups) {
    double mean = 0, weights = 0;
    for (const Estimate& e : group) {
      const double w = 1 / (variance_of(e) + all.between);
      mean += w * e.value;
      weights += w;
    }
    between += weights * (mean / weights - all.mean.value) * (mean / weights - all.mean.value);
  }
  return std::max(1.0, std::sqrt(between / static_cast<double>(groups.size() - 1)));
}

// The same to a hundredth, or both not given.
bool alike(double a, double b) {
  return (std::isnan(a) && std::isnan(b)) || std::abs(a - b) <= 0.01 * std::max(std::abs(a), std::abs(b));
}

double size_of(const Bounce& b) {
  return std::isfinite(b.ball_radius) ? b.ball_radius : std::cbrt(0.75 * b.ball_mass / (kPi * kSteel));
}

bool differ(const Eigen::VectorXd& x) {
  return x.allFinite() && x.maxCoeff() - x.minCoeff() > 0.05 * std::abs(x.mean());
}

// Straight lines in speed and size together, so that neither stands for the other.
void find_slopes(std::span<const Bounce> bounces, RestitutionResult& r) {
  const auto n = static_cast<Eigen::Index>(bounces.size());
  Eigen::VectorXd e(n), v(n), size(n), weight(n);
  bool weighted = true;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    e[i] = r.impacts[at].restitution.value;
    v[i] = r.impacts[at].speed;
    size[i] = size_of(bounces[at]);
    weighted = weighted && variance_of(r.impacts[at].restitution) > 0;
  }
  for (Eigen::Index i = 0; i < n; ++i)
    weight[i] = weighted ? 1 / r.impacts[static_cast<std::size_t>(i)].restitution.se : 1;
  std::vector<std::pair<const Eigen::VectorXd*, Estimate*>> lines;
  if (differ(v)) lines.emplace_back(&v, &r.slope_speed);
  if (differ(size)) lines.emplace_back(&size, &r.slope_size);
  const auto columns = static_cast<Eigen::Index>(lines.size()) + 1;
  const double freedom = static_cast<double>(n - columns);
  if (lines.empty() || freedom < 1) return;
  Eigen::MatrixXd a(n, columns);
  a.col(0) = weight;
  for (Eigen::Index k = 1; k < columns; ++k) {
    const Eigen::VectorXd& x = *lines[static_cast<std::size_t>(k - 1)].first;
    a.col(k) = weight.array() * (x.array() - x.mean()) / (x.maxCoeff() - x.minCoeff());
  }
  const Eigen::MatrixXd normal = a.transpose() * a;
  const Eigen::FullPivLU<Eigen::MatrixXd> lu(normal);
  if (lu.rcond() < 1e-6) return;  // large balls from high, small from low: nothing tells the two apart
  const Eigen::MatrixXd inverse = lu.inverse();
  const Eigen::VectorXd wanted = weight.array() * e.array();
  const Eigen::VectorXd found = inverse * (a.transpose() * wanted);
  const double variance = (wanted - a * found).squaredNorm() / freedom;
  for (Eigen::Index k = 1; k < columns; ++k) {
    const auto& [x, slope] = lines[static_cast<std::size_t>(k - 1)];
    const double span = x->maxCoeff() - x->minCoeff();
    *slope = {found[k] / span, std::sqrt(variance * inverse(k, k)) / span};
    const bool matters = std::abs(slope->value) > student_95(freedom) * slope->se;
    (slope == &r.slope_speed ? r.speed_matters : r.size_matters) = matters;
  }
}

// e = A + B exp(-v / v_e): linear but for v_e, which is searched on a fine logarithmic grid within what the speeds can
// show; A = e0 (1 - drop), B = e0 drop. Errors from the curvature at the best (Gauss-Newton).
void find_falling(RestitutionResult& r) {
  const auto n = static_cast<Eigen::Index>(r.impacts.size());
  Eigen::VectorXd e(n), v(n), weight(n);
  bool weighted = true;
  for (const Impact& impact : r.impacts) weighted = weighted && variance_of(impact.restitution) > 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Impact& impact = r.impacts[static_cast<std::size_t>(i)];
    e[i] = impact.restitution.value;
    v[i] = impact.speed;
    weight[i] = weighted ? 1 / impact.restitution.se : 1;
  }
  std::vector<double> speeds(v.begin(), v.end());
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end(), [](double a, double b) { return b < 1.05 * a; }),
               speeds.end());
  if (speeds.size() < 5 || n < 6 || speeds.back() < 3 * speeds.front()) {
    r.why_not_falling = "five speeds over a factor of three (nine in height) are needed to fit e(v)";
    return;
  }
  if (!r.speed_matters || r.slope_speed.value > 0) {
    r.why_not_falling = "restitution does not fall with speed beyond its error";
    return;
  }
  const Eigen::VectorXd wanted = weight.array() * e.array();
  const auto solve = [&](double speed, Eigen::Vector2d& linear) {
    Eigen::MatrixX2d a(n, 2);
    a.col(0) = weight;
    a.col(1) = weight.array() * (-v.array() / speed).exp();
    linear = a.colPivHouseholderQr().solve(wanted);
    return (wanted - a * linear).squaredNorm();
  };
  const double low = speeds.front() / 3, high = 3 * speeds.back();
  constexpr int kSteps = 2000;
  int best = 0;
  double least = INFINITY;
  Eigen::Vector2d linear;
  for (int i = 0; i <= kSteps; ++i) {
    const double rest = solve(low * std::pow(high / low, double(i) / kSteps), linear);
    if (rest < least) {
      least = rest;
      best = i;
    }
  }
  const double speed = low * std::pow(high / low, double(best) / kSteps);
  solve(speed, linear);
  const double e0 = linear.sum(), drop = linear[1] / e0;
  if (best == 0 || best == kSteps || !(drop > 0) || !(drop <= 0.99) || !(e0 <= 1) || !(e0 > 0)) {
    r.why_not_falling = "e falls with speed, but the speeds do not fix where it begins or ends";
    return;
  }
  Eigen::MatrixX3d slopes(n, 3);  // by e0, drop, v_e
  for (Eigen::Index i = 0; i < n; ++i) {
    const double decay = std::exp(-v[i] / speed);
    slopes.row(i) << 1 - drop * (1 - decay), -e0 * (1 - decay), e0 * drop * decay * v[i] / (speed * speed);
    slopes.row(i) *= weight[i];
  }
  const Eigen::Matrix3d covariance = (slopes.transpose() * slopes).inverse() * least / static_cast<double>(n - 3);
  const auto with_se = [&](double value, int k) { return Estimate{value, std::sqrt(covariance(k, k))}; };
  const FallingRestitution found{with_se(e0, 0), with_se(drop, 1), with_se(speed, 2)};
  if (!(found.speed.se < 0.5 * speed) || !(found.drop.se < 0.5 * drop)) {
    r.why_not_falling = "e falls with speed, but drop or speed of the fit are uncertain by more than half";
    return;
  }
  r.falling = found;
}

}  // namespace

Impact impact_of(const Bounce& b, BounceKind kind) {
  const double root = std::sqrt(b.rebound_height / b.fall_height);
  const double ratio = std::isfinite(b.target_mass) && std::isfinite(b.ball_mass) ? b.target_mass / b.ball_mass : 1.0;
  const double factor = kind == BounceKind::kDrop ? 1 : 1 + ratio;
  Impact impact{std::sqrt(2 * kGravity * b.fall_height),
                {factor * root - (kind == BounceKind::kDrop ? 0 : 1), kNotGiven}};
  if (b.fall_uncertainty > 0 || b.rebound_uncertainty > 0) {
    const double of_fall = b.fall_uncertainty / b.fall_height;
    const double of_rebound = b.rebound_height > 0 ? b.rebound_uncertainty / b.rebound_height : 0;
    impact.restitution.se = 0.5 * factor * root * std::hypot(of_fall, of_rebound);
  }
  return impact;
}

Estimate damping_constant(const Estimate& e, const Estimate& k, double mass) {
  if (!(e.value > 0) || !(k.value > 0) || !(mass > 0)) return {};
  const double value = 2 * sim::damping_ratio(std::min(e.value, 1.0)) * std::sqrt(mass * k.value);
  // dz/de = -pi^2 / (e (ln^2 e + pi^2)^(3/2)) with z the share of critical damping; C = 2 z sqrt(m k).
  const double l = std::log(std::min(e.value, 1.0)), q = l * l + kPi * kPi;
  const double by_e =
      2 * std::sqrt(mass * k.value) * kPi * kPi / (e.value * q * std::sqrt(q)) * std::sqrt(variance_of(e));
  const double by_k = 0.5 * value / k.value * std::sqrt(variance_of(k));
  return {value, std::hypot(by_e, by_k)};
}

RestitutionResult restitution_from(std::span<const Bounce> bounces, BounceKind kind, const Estimate& stiffness) {
  RestitutionResult r;
  std::vector<Estimate> all;
  std::vector<std::vector<Estimate>> of_group;
  for (const Bounce& b : bounces) {
    r.impacts.push_back(impact_of(b, kind));
    all.push_back(r.impacts.back().restitution);
    auto group = std::find_if(r.groups.begin(), r.groups.end(), [&](const BallGroup& g) {
      return alike(g.ball_mass, b.ball_mass) && alike(g.ball_radius, b.ball_radius) &&
             alike(g.target_mass, b.target_mass);
    });
    if (group == r.groups.end()) {
      BallGroup added;
      added.ball_mass = b.ball_mass;
      added.ball_radius = b.ball_radius;
      added.target_mass = b.target_mass;
      const double other = std::isfinite(b.target_mass) ? b.target_mass : b.ball_mass;
      added.effective_mass = kind == BounceKind::kDrop ? b.ball_mass : b.ball_mass * other / (b.ball_mass + other);
      r.groups.push_back(added);
      of_group.emplace_back();
      group = r.groups.end() - 1;
    }
    of_group[static_cast<std::size_t>(group - r.groups.begin())].push_back(all.back());
    ++group->impacts;
  }
  if (all.empty()) return r;
  for (std::size_t i = 0; i < r.groups.size(); ++i) {
    r.groups[i].restitution = weighted_mean(of_group[i]).mean;
    r.groups[i].damping = damping_constant(r.groups[i].restitution, stiffness, r.groups[i].effective_mass);
  }
  const Mean mean = weighted_mean(all);
  r.mean = {mean.mean.value, mean.mean.se * birge_ratio(mean, of_group)};
  find_slopes(bounces, r);
  find_falling(r);
  return r;
}

}  // namespace tumble::diagnose
