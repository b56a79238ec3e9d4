#pragma once
#include <span>
#include <string>
#include <vector>

#include "diagnose/contact_events.h"
#include "diagnose/measurement.h"
#include "sim/config_laws.h"

// Laws measured at single balls, from nothing but where they are seen: what brakes and lifts them in flight, how they
// rebound, rub and roll off in impacts. A law names what is missing by itself, without a library of simulations, and is
// drawn over the model's. Docs: docs/contact-laws.md.
//
// All are ratios of sums over flights or impacts, which noise of the places does not bias: what an impact is chosen and
// sorted by comes from other frames than what is summed up.
namespace tumble::diagnose {

struct LawParameter {  // a law in one number
  std::string name, unit;
  double value = kNotGiven, se = kNotGiven;
  double model = kNotGiven;  // the same fit to the model's law
};

struct MeasuredLaw {
  std::string name;  // "restitution, ball on ball"
  std::string x_name, x_unit, y_name, y_unit;
  std::vector<double> x = {}, y = {}, se = {};  // bins that hold enough; by x
  std::vector<double> model = {};               // the config's own law, averaged over the same flights or impacts
  std::vector<int> count = {};                  // of flights or impacts in each
  double z = kNotGiven;                         // chi-square of y against model as a normal deviate
  double freedom = 0;                           // of that chi-square
  std::vector<LawParameter> parameters = {};
  std::vector<std::string> speaks_for = {};  // suspects that bend this law
  std::string says = {};                     // in one sentence
};

// The same laws as a row of numbers that a film and a simulation give alike. NaN where too little is seen.
struct LawNumbers {
  std::vector<double> value, se;
};
inline constexpr std::size_t kLawNumbers = 19;
const char* name_of_law_number(std::size_t i);  // "restitution, ball on ball, 2"

class ContactLaws {
 public:
  // `model`: complete. Friction is read from impacts that slide through by its coefficient; whoever compares numbers
  // uses one model for all.
  explicit ContactLaws(const Config& model);

  void add(double time, double mill_angle, std::span<const Sighting> balls) { events_.add(time, mill_angle, balls); }

  std::vector<MeasuredLaw> laws() const;
  // As this observer would have it.
  LawNumbers numbers(const Observer& observer = {}) const;
  const ContactEvents& events() const { return events_; }

 private:
  Config config_;
  sim::ConfigLaws model_;
  ContactEvents events_;
};

std::vector<MeasuredLaw> measured_laws(std::span<const SeenFrame> frames, const Config& model);

}  // namespace tumble::diagnose
