#pragma once
#include <string>

#include "core/diagnosis.h"

// A verdict in words, for page, file and console.
namespace tumble::io {

// A heading: "The balls roll less freely than the model has it".
std::string diagnosis_title(const Diagnosis& diagnosis);
// One or two sentences with the numbers.
std::string diagnosis_sentence(const Diagnosis& diagnosis);

// The same where the heading stands above it: without what that says already.
std::string sentence_below_title(const Diagnosis& diagnosis);

std::string with_capital(std::string text);                       // of ASCII
std::string gap_in_words(double chi);                             // "4.9", "12"
std::string gaps_in_words(double from, double to);                // "4.9 → 1.2", or the one that is known
std::string probability_in_words(double probability);             // "0.97", "above 0.999"
std::string parameter_in_words(const FoundParameter& parameter);  // "coefficient 0.0213 ± 0.0031", "+2.0 ± 0.1 %"
std::string condition_in_words(const DiagnosedExperiment& e);     // "0.70 of critical, filling 35 %"

}  // namespace tumble::io
