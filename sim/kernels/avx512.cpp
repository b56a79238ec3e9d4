// Compiled for AVX-512, see avx2.cpp.
#include "sim/kernels/loops.h"

namespace tumble::sim {
const Kernels kAvx512Kernels = kernels_of<xsimd::batch<double, xsimd::avx512f>>("avx512");
}  // namespace tumble::sim
