#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnose/contact_stiffness.h"
#include "diagnose/restitution.h"
#include "io/plot_page.h"

// What `tumble parameters` found, ready to be read: as text, as a page, as JSON.
namespace tumble::cli {

struct Findings {
  std::string kind, title;
  std::vector<std::string> lines;  // one finding each
  std::vector<std::string> caveats;
  std::vector<io::PageTable> tables;
  std::vector<io::Plot> plots;
  std::string toml;             // lines of MILL.toml to paste
  nlohmann::ordered_json json;  // everything, with standard errors
};

// `layers`: of the group that goes into MILL.toml; < 0 = fewest but bare metal. `restitution`: for the damping of eq.
// 13; NaN = not asked for.
Findings findings_of(const std::vector<diagnose::StiffnessGroup>& groups, int layers, double restitution);

// `stiffness`: for the damping of eq. 13; NaN = not asked for.
Findings findings_of(const diagnose::RestitutionResult& result, diagnose::BounceKind kind, double stiffness);

std::string text_of(const Findings& findings);  // without the caveats; the lines of MILL.toml come last
io::PlotPage page_of(const Findings& findings);

}  // namespace tumble::cli
