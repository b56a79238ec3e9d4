#pragma once
#include <string>

#include "core/diagnosis.h"

// A verdict in words, for page, file and console.
namespace tumble::io {

// A heading: "The balls roll less freely than the model has it".
std::string diagnosis_title(const Diagnosis& diagnosis);
// One or two sentences with the numbers.
std::string diagnosis_sentence(const Diagnosis& diagnosis);

std::string probability_in_words(double probability);             // "0.97", "above 0.999"
std::string parameter_in_words(const FoundParameter& parameter);  // "coefficient 0.0213 ± 0.0031", "+2.0 ± 0.1 %"

}  // namespace tumble::io
