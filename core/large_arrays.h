#pragma once

namespace tumble {

// From here on arrays of a quarter of a megabyte and more go back to the system at once when they are freed. Else the
// allocator keeps up to 32 MB apiece in its heap, a tenth of the memory of a mill of many balls.
void give_large_arrays_back();

}  // namespace tumble
