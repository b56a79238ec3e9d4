#include "analysis/block_sums.h"

#include <algorithm>

namespace tumble::analysis {
namespace {

void add_to(std::vector<double>& sum, std::span<const double> row) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += row[i];
}

}  // namespace

void BlockSums::add(std::span<const double> row) {
  if (sums_.empty() || in_last_ == length_) {
    if (sums_.size() == most_) {
      for (std::size_t i = 0; i < most_ / 2; ++i) {
        if (i > 0) sums_[i] = std::move(sums_[2 * i]);
        add_to(sums_[i], sums_[2 * i + 1]);
      }
      sums_.resize(most_ / 2);
      length_ *= 2;
    }
    sums_.emplace_back(columns_, 0.0);
    in_last_ = 0;
  }
  add_to(sums_.back(), row);
  ++in_last_;
  ++rows_;
}

std::vector<double> BlockSums::total() const {
  std::vector<double> sum(columns_, 0.0);
  for (const auto& block : sums_) add_to(sum, block);
  return sum;
}

std::vector<std::vector<double>> BlockSums::batches(std::size_t count) const {
  const std::size_t each = std::max<std::size_t>(1, sums_.size() / std::max<std::size_t>(1, count));
  std::vector<std::vector<double>> result;
  std::size_t in_last = 0;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    if (i % each == 0) {
      result.emplace_back(columns_, 0.0);
      in_last = 0;
    }
    add_to(result.back(), sums_[i]);
    ++in_last;
  }
  if (result.size() > 1 && 2 * in_last < each) {
    add_to(result[result.size() - 2], result.back());
    result.pop_back();
  }
  return result;
}

}  // namespace tumble::analysis
