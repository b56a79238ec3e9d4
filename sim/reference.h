#pragma once
#include <vector>

#include "sim/charge.h"
#include "sim/ledger.h"
#include "sim/mill_model.h"
#include "sim/running_mill.h"

namespace tumble::sim {

// The same mill once more, as plainly as it can be written: every pair and every lifter looked at in every step, memory
// in full tables, nothing skipped. It is the oracle for sim/running_mill.cpp: from the same start both give the same
// bits.
struct ReferenceMill {
  MillModel model;
  ExactSums exact;
  Charge charge;
  Ledger ledger;  // drive work, dissipation, torque sums; no impacts
  std::int64_t step = 0;
  struct Memory {
    bool touching = false;
    ContactState state;
    TermState terms;
  };
  std::vector<Memory> with_ball;     // of (i, j > i) at i n + j
  std::vector<Memory> with_feature;  // of (i, feature) at i (lifters + 1) + feature
};

// Balls at step 0, as for start_mill.
ReferenceMill make_reference_mill(const MillModel& model, Charge charge);
void advance(ReferenceMill& mill);

}  // namespace tumble::sim
