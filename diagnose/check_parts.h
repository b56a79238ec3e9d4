#pragma once
#include <span>
#include <string>
#include <vector>

#include "diagnose/exact_checks.h"
#include "diagnose/free_flight.h"

// What the exact checks are put together from: one function a subject, each with none, one or several checks.
namespace tumble::diagnose {

// `usual`, `odd`: what is said where the number is as expected, and where it is not; the numbers themselves come before
// that.
struct Saying {
  std::string what;  // "balls in flight fall with"
  std::string usual, odd;
};

// `z`: where it is not the difference in standard errors.
ExactCheck make_check(const Measurement& m, const std::string& name, double found, double expected, double se,
                      const std::string& unit, const std::vector<MovedBy>& moved_by, const Saying& saying,
                      double z = kNotGiven);

void check_drum(const Measurement& m, std::vector<ExactCheck>& checks);     // its speed, and that it is even
void check_lengths(const Measurement& m, std::vector<ExactCheck>& checks);  // where balls touch, and the shell
void check_balls(const Measurement& m, std::vector<ExactCheck>& checks);    // their number and sizes
void check_flights(const Measurement& m, std::vector<ExactCheck>& checks);  // what acts on balls that touch nothing
void check_balance(const Measurement& m, std::vector<ExactCheck>& checks);  // torque, weight and power

// The windows in which nothing was hit; for those who look at flights more closely.
std::vector<FreeFall> clean_flights(const Measurement& m);

}  // namespace tumble::diagnose
