#include "sim/kernels/loops.h"

namespace tumble::sim {
const Kernels kScalarKernels = kernels_of<double>("scalar");
}  // namespace tumble::sim
