#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace tumble::analysis {

// Sums of a row of numbers over consecutive blocks of frames, for standard errors that allow for correlation in time
// at a memory that does not grow with the film: when the blocks are full, neighbours merge and the blocks double.
class BlockSums {
 public:
  BlockSums(std::size_t columns, std::size_t most_blocks) : columns_(columns), most_(most_blocks) {}

  void add(std::span<const double> row);  // one frame

  std::size_t columns() const { return columns_; }
  std::size_t rows() const { return rows_; }            // frames added
  std::size_t block_length() const { return length_; }  // frames per block; the last block may be shorter
  std::size_t count() const { return sums_.size(); }
  std::span<const double> block(std::size_t i) const { return sums_[i]; }
  std::vector<double> total() const;

  // The same sums in about `count` blocks of equal length, for batch means; a rest of less than half a batch is
  // joined to the last one.
  std::vector<std::vector<double>> batches(std::size_t count) const;

 private:
  std::size_t columns_, most_, length_ = 1, rows_ = 0, in_last_ = 0;
  std::vector<std::vector<double>> sums_;
};

}  // namespace tumble::analysis
