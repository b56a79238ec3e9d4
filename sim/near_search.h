#pragma once
#include "sim/running_mill.h"

namespace tumble::sim {

// Finds all pairs nearer than touching + skin that do not touch at the balls' present positions. `settled`: contact
// forces have been worked out at these positions, so what touches is in the tables already; else every pair that is not
// in a table is near, if it touches or not.
void search_near(RunningMill& mill, bool settled);

}  // namespace tumble::sim
