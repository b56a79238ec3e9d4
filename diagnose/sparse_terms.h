#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

// The few terms of a dictionary that explain a response, by least squares over all sets of at most three.
namespace tumble::diagnose {

// Sums of products over one part of the data: of all terms and, last, the response; weights are inverse variances up to
// one factor.
struct TermSums {
  explicit TermSums(int terms) : products(Eigen::MatrixXd::Zero(terms + 1, terms + 1)) {}
  void add(const Eigen::VectorXd& terms_and_response, double weight);
  Eigen::MatrixXd products;
  double rows = 0;
};

struct SparseTerm {
  int term = 0;
  double coefficient = 0, se = 0, inclusion = 0, p = 1;
};

// Those with an inclusion of 0.9 and more and p of at most 0.01. Deterministic.
std::vector<SparseTerm> sparse_terms(const std::vector<TermSums>& parts);

}  // namespace tumble::diagnose
