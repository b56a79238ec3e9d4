#pragma once

namespace tumble {

// From here on arrays of a quarter of a megabyte and more go back to the system at once when they are freed. Else the
// allocator keeps up to 32 MB apiece in its heap, a tenth of the memory of a mill of many balls.
void give_large_arrays_back();

// From here on they stay with the process, to be used again: for work that takes and frees the same pictures over and
// over, and would else have the system clear new pages for each.
void keep_large_arrays();

}  // namespace tumble
