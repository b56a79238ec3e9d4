#pragma once
#include "diagnose/build_library.h"

// A library in parts, for those who make it on many machines.
namespace tumble::diagnose {

// The runs of one file: some of a block of what is to be simulated of a condition.
struct LibraryChunk {
  std::size_t condition, block, first, count;
  std::size_t number;  // among the condition's
};

// All of a library of `blocks` blocks, in an order in which all conditions grow together. Deterministic.
std::vector<LibraryChunk> plan_chunks(const std::vector<Condition>& conditions,
                                      const std::vector<UncertainKey>& uncertain, std::size_t blocks);

// As build_library, of these chunks alone.
std::size_t build_chunks(std::vector<Condition>& conditions, const std::vector<UncertainKey>& uncertain,
                         const std::vector<LibraryChunk>& chunks, const MillWith& mill_with, const LibrarySink& sink);

}  // namespace tumble::diagnose
