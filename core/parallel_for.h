#pragma once
#include <cstddef>
#include <functional>

namespace tumble {

// Threads that parallel_for may use from now on; 0 = all of the machine's. Set once, by the command line.
void limit_threads(int count);
int thread_limit();

// Calls body(begin, end) for disjoint ranges that cover [0, count), on several threads. The ranges depend on `count`
// and `grain` alone, never on the number of threads, so a result summed per range in order keeps its bits.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace tumble
