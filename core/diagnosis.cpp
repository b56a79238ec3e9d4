#include "core/diagnosis.h"

#include <cmath>

namespace tumble {
namespace {

Gap gap_of(const Diagnosis& diagnosis, double GapRow::*chi) {
  Gap gap;
  for (const bool hold_out : {false, true}) {
    double sum = 0;
    int count = 0;
    for (const GapRow& row : diagnosis.gaps) {
      if (row.hold_out != hold_out || std::isnan(row.*chi)) continue;
      sum += (row.*chi) * (row.*chi);
      ++count;
    }
    if (count > 0) (hold_out ? gap.hold_out : gap.fit) = std::sqrt(sum / count);
  }
  return gap;
}

}  // namespace

Gap gap_before(const Diagnosis& diagnosis) { return gap_of(diagnosis, &GapRow::before); }
Gap gap_after(const Diagnosis& diagnosis) { return gap_of(diagnosis, &GapRow::after); }
Gap gap_of_runner_up(const Diagnosis& diagnosis) { return gap_of(diagnosis, &GapRow::runner_up); }

const DiagnosedExperiment* experiment_of(const Diagnosis& d, const std::string& name) {
  for (const DiagnosedExperiment& e : d.experiments)
    if (e.name == name) return &e;
  return nullptr;
}

}  // namespace tumble
