// Compiled for AVX2: no function may come out of it that other files have too, for the linker might take this one for
// all (tests/sim/kernel_symbols.sh looks).
#include "sim/kernels/loops.h"

namespace tumble::sim {
const Kernels kAvx2Kernels = kernels_of<xsimd::batch<double, xsimd::avx2>>("avx2");
}  // namespace tumble::sim
