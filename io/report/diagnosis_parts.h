#pragma once
#include <string>

#include "core/diagnosis.h"
#include "io/report/html.h"

// What only the page of a diagnosis has, as HTML; each empty where the diagnosis has nothing of it.
namespace tumble::io::report {

// z over the mill before and after, of every experiment and observable, and the numbers beyond chance.
std::string where_html(const Diagnosis& diagnosis);
Json maps_json(const Diagnosis& diagnosis);  // what diagnosis.js needs for it

std::string proof_html(const Diagnosis& diagnosis);     // the gap of every experiment before and after
std::string suspects_html(const Diagnosis& diagnosis);  // probabilities as bars, what was ruled out, what is alike
std::string next_html(const Diagnosis& diagnosis);      // experiments that would tell
std::string model_html(const Diagnosis& diagnosis);     // model.toml with what is new in it marked

// "occupancy", "momentum, upwards"
std::string words_of_observable(const std::string& name);

}  // namespace tumble::io::report
