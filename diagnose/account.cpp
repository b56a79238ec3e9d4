#include "diagnose/account.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble::diagnose {
namespace {

// The places and gaps of every experiment, before and after.
class Account {
 public:
  Account(const std::vector<Scene>& scenes, const Proof& before, const Proof& after, const Proof* runner_up)
      : scenes_(scenes), before_(before), after_(after), runner_up_(runner_up) {}

  void fill(Diagnosis& d) const {
    for (std::size_t i = 0; i < scenes_.size(); ++i) fill(d, i);
    std::stable_sort(d.where.begin(), d.where.end(),
                     [](const PlaceOfGap& a, const PlaceOfGap& b) { return std::abs(a.z) > std::abs(b.z); });
  }

 private:
  void fill(Diagnosis& d, std::size_t index) const {
    const Scene& scene = scenes_[index];
    const Experiment& e = scene.measurement->experiment;
    const ObservationLayout layout(scene.measurement->config.mill.lifters.count);
    std::vector<const Replicas*> sets{&before_.runs[index], &after_.runs[index]};
    if (runner_up_ != nullptr) sets.push_back(&runner_up_->runs[index]);
    const Chance chance = chance_of(sets);
    if (chance.left_out.empty()) return;
    const Contrast before = contrast(scene, before_.model, before_.runs[index], chance),
                   after = contrast(scene, after_.model, after_.runs[index], chance);
    GapRow row{e.name, e.hold_out, before.chi, after.chi, kNotGiven, scene.measurement->torque, {}, {}};
    if (runner_up_ != nullptr) row.runner_up = contrast(scene, runner_up_->model, runner_up_->runs[index], chance).chi;
    row.torque_before = torque_of(before_.runs[index]);
    row.torque_after = torque_of(after_.runs[index]);
    d.gaps.push_back(row);

    std::vector<double> z_before(layout.size(), kNotGiven), z_after = z_before, measured = z_before,
                                                            shown_before = z_before, shown_after = z_before;
    for (std::size_t k = 0; k < before.numbers.size(); ++k) {
      z_before[before.numbers[k]] = before.z[k];
      measured[before.numbers[k]] = before.measured[k];
      shown_before[before.numbers[k]] = before.simulated[k];
    }
    for (std::size_t k = 0; k < after.numbers.size(); ++k) {
      z_after[after.numbers[k]] = after.z[k];
      shown_after[after.numbers[k]] = after.simulated[k];
    }
    for (const Observable o : kObservables) {
      const std::size_t first = layout.first(o), count = layout.count(o);
      const double limit = chance_limit(chance, first, count);
      double chi_before = 0, chi_after = 0, n = 0;
      for (std::size_t k = first; k < first + count; ++k) {
        if (std::isnan(z_before[k]) || std::isnan(z_after[k])) continue;
        chi_before += z_before[k] * z_before[k];
        chi_after += z_after[k] * z_after[k];
        n += 1;
        if (std::abs(z_before[k]) > limit)
          d.where.push_back({e.name, name_of(o), layout.region(k), z_before[k], z_after[k]});
      }
      if (n == 0) continue;
      chi_before = std::sqrt(chi_before / n);
      chi_after = std::sqrt(chi_after / n);
      // Worse by more than two standard errors of a root mean square of n numbers.
      if (chi_after > chi_before + 2 * chi_after / std::sqrt(2 * n))
        d.worse.push_back({e.name, name_of(o), chi_before, chi_after});
      add_map(d, e.name, o, layout, {measured, shown_before, shown_after, z_before, z_after}, limit);
    }
  }

  static Estimate torque_of(const Replicas& runs) {
    std::vector<Estimate> torques;
    for (const auto& seen : runs.seen) torques.push_back({seen[0], kNotGiven});
    return mean_of_repeats(torques);
  }

  void add_map(Diagnosis& d, const std::string& experiment, Observable o, const ObservationLayout& layout,
               const std::array<std::vector<double>, 5>& numbers, double limit) const {
    const bool round = o == Observable::kPockets;
    if (!round && o != Observable::kOccupancy && o != Observable::kMomentum && o != Observable::kAgitation &&
        o != Observable::kSpin)
      return;
    const std::size_t parts = round || o == Observable::kMomentum ? 2 : 1, each = layout.count(o) / parts;
    for (std::size_t part = 0; part < parts; ++part) {
      GapMap map;
      map.experiment = experiment;
      map.observable = round                        ? (part == 0 ? "pockets" : "slip")
                       : o == Observable::kMomentum ? (part == 0 ? "momentum_x" : "momentum_y")
                                                    : name_of(o);
      map.n = round ? 0 : kCells;
      map.cell = 2.0 / kCells;
      map.limit = limit;
      std::array<std::vector<double>*, 5> into{&map.measured, &map.before, &map.after, &map.z_before, &map.z_after};
      for (std::size_t which = 0; which < into.size(); ++which) {
        const auto from = numbers[which].begin() + static_cast<std::ptrdiff_t>(layout.first(o) + part * each);
        if (round) {
          into[which]->assign(from, from + static_cast<std::ptrdiff_t>(each));
          continue;
        }
        for (const int cell : layout.cell_at) into[which]->push_back(cell < 0 ? kNotGiven : from[cell]);
      }
      if (&before_ == &after_) map.after.clear(), map.z_after.clear();
      d.maps.push_back(std::move(map));
    }
  }

  const std::vector<Scene>& scenes_;
  const Proof &before_, &after_;
  const Proof* runner_up_;
};

}  // namespace

void give_account(Diagnosis& diagnosis, const std::vector<Scene>& scenes, const Proof& before, const Proof& after,
                  const Proof* runner_up) {
  Account(scenes, before, after, runner_up).fill(diagnosis);
}

}  // namespace tumble::diagnose
