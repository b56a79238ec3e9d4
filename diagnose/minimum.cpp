#include "diagnose/minimum.h"

#include <nlopt.h>

#include <cmath>
#include <memory>
#include <stdexcept>

namespace tumble::diagnose {
namespace {

constexpr double kNowhere = 1e30;  // for a value that is none: no minimum is there

struct Call {
  const std::function<double(const std::vector<double>&)>& f;
  std::vector<double> at;
};

double evaluate(unsigned n, const double* x, double*, void* data) {
  Call& call = *static_cast<Call*>(data);
  call.at.assign(x, x + n);
  const double value = call.f(call.at);
  return std::isfinite(value) ? value : kNowhere;
}

struct Destroy {
  void operator()(nlopt_opt_s* o) const { nlopt_destroy(o); }
};

void checked(nlopt_result result) {
  if (result < 0 && result != NLOPT_ROUNDOFF_LIMITED) throw std::runtime_error("NLopt refused its settings");
}

}  // namespace

std::vector<double> minimum_near(const std::function<double(const std::vector<double>&)>& f, std::vector<double> start,
                                 const Box& box, double tolerance, int most_calls) {
  const std::unique_ptr<nlopt_opt_s, Destroy> optimiser(
      nlopt_create(NLOPT_LN_SBPLX, static_cast<unsigned>(start.size())));
  if (!optimiser) throw std::bad_alloc();
  Call call{f, {}};
  std::vector<double> step;
  for (std::size_t k = 0; k < start.size(); ++k) step.push_back(0.1 * (box.high[k] - box.low[k]));
  checked(nlopt_set_min_objective(optimiser.get(), evaluate, &call));
  checked(nlopt_set_lower_bounds(optimiser.get(), box.low.data()));
  checked(nlopt_set_upper_bounds(optimiser.get(), box.high.data()));
  checked(nlopt_set_initial_step(optimiser.get(), step.data()));
  checked(nlopt_set_xtol_abs1(optimiser.get(), tolerance));
  checked(nlopt_set_maxeval(optimiser.get(), most_calls));
  double value = 0;
  checked(nlopt_optimize(optimiser.get(), start.data(), &value));
  return start;
}

}  // namespace tumble::diagnose
