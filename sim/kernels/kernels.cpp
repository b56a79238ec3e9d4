#include "sim/kernels/kernels.h"

#include <algorithm>
#include <array>

namespace tumble::sim {

void KickSums::add(const KickSums& s) {
  fastest2 = std::max(fastest2, s.fastest2);
  mass_moment += s.mass_moment;
  ends_torque += s.ends_torque;
  ends_loss += s.ends_loss;
  drag_loss += s.drag_loss;
  pool_loss += s.pool_loss;
  external += s.external;
  finite = finite && s.finite;
}

std::vector<const Kernels*> all_kernels() {
  std::vector<const Kernels*> all;
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    all.push_back(&kAvx512Kernels);
  if (__builtin_cpu_supports("avx2")) all.push_back(&kAvx2Kernels);
#endif
  all.push_back(&kScalarKernels);
  return all;
}

const Kernels& best_kernels() {
  static const Kernels& best = *all_kernels().front();
  return best;
}

}  // namespace tumble::sim
