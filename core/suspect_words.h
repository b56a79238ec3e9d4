#pragma once
#include <string>

// What a suspect of a diagnosis is called, and what it does, for a reader.
namespace tumble {

// "rolling resistance"; of a name without words of its own its letters alone.
std::string words_of_suspect(const std::string& name);

// "The balls roll less freely than the model has it": of a change of this sign. Without a full stop.
std::string statement_of_suspect(const std::string& name, double strength);

}  // namespace tumble
