// Compiled for AVX2: nothing may be included that other files compile too and might share (see tests/sim/kernels).
#include "sim/kernels/loops.h"

namespace tumble::sim {
const Kernels kAvx2Kernels = kernels_of<xsimd::batch<double, xsimd::avx2>>("avx2");
}  // namespace tumble::sim
