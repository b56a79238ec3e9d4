#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/diagnosis.h"

// What `tumble diagnose` writes, from what it found alone.
namespace tumble::io {

// verdict.json: docs/diagnosis.md. Numbers that cannot be had are null.
std::string diagnosis_json(const Diagnosis& diagnosis);

struct DiagnosisFilm {  // measured, before and after side by side
  std::filesystem::path file;
  std::string caption;
};

// report.html: one self-contained file. Throws WorkError where a film cannot be read or the page not be written.
void write_diagnosis_page(const std::filesystem::path& path, const Diagnosis& diagnosis,
                          const std::vector<DiagnosisFilm>& films);

// model.toml: the text of MILL.toml (`name`, for messages) with what was found, and all else as its author wrote it.
// Effects become [effects.NAME], errors in what was told of the mill its corrected keys, errors of measuring
// [measurement], and the uncertain keys are as they were fitted with all that; each with what it was, its error and its
// probability as comments. Where the data cannot tell suspects apart the likeliest is added, the others are named. An
// agreement or an unknown effect changes nothing.
std::string repaired_mill(const std::string& mill_toml, const std::string& name, const Diagnosis& diagnosis);

// model_tabulated.toml: the same text with laws found by regression (`sets`, as --set takes them) and the uncertain
// keys as they were refitted without them.
std::string tabulated_mill(const std::string& mill_toml, const std::string& name, const Diagnosis& diagnosis,
                           const std::vector<std::string>& sets);

}  // namespace tumble::io
