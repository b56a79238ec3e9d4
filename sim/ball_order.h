#pragma once
#include "sim/running_mill.h"

// Where in memory a ball is stored. It changes no bit of what is simulated; neighbours that lie side by side are found
// sooner.
namespace tumble::sim {

// Puts the balls and the contacts in the order of the grid, as it has just been filled. Near pairs must be searched for
// afterwards.
void sort_by_cell(RunningMill& mill);

// Ball number k at place k.
void sort_by_number(RunningMill& mill);

}  // namespace tumble::sim
