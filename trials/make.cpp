#include "trials/make.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/version.h"
#include "diagnose/in_turns.h"
#include "io/config_file.h"
#include "io/output.h"
#include "io/text_file.h"
#include "trials/key_file.h"

namespace tumble::trials {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPlanFile = "plan.txt";

// All that the trials hang on beside their keys: a set that is gone on with must be asked for in the same words.
std::string plan_text(const MakePlan& plan) {
  const LabPlan& lab = plan.lab;
  std::string text = fmt::format("tumble {}\ntrials {}\nkinds", kVersion, plan.draw.n);
  for (const Kind kind : plan.draw.kinds) text += fmt::format(" {}", name_of(kind));
  text += fmt::format("\ndata {}\n", name_of(plan.draw.tier));
  for (const Condition& c : lab.conditions) {
    text += fmt::format("condition \"{}\"{}", c.name, c.hold_out ? " hold_out" : "");
    for (const auto& [key, value] : c.sets) text += fmt::format(" {}={}", key, value);
    text += "\n";
  }
  for (const UncertainKey& u : lab.uncertain) text += fmt::format("uncertain {}={}\n", u.key, u.sd);
  const TrackingErrors& t = lab.tracking;
  text += fmt::format("tracking {} {} {} {}\ntorque {} {}\nangles {}\nfilm {}x{}\n\n", t.place, t.angle, t.radius,
                      t.mill_angle, lab.torque_noise, lab.torque_error, lab.angle_error_deg, lab.width, lab.height);
  return text + io::to_toml(lab.mill);
}

bool holds_something(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder, error) && !fs::is_empty(folder, error);
}

// Throws where they are there already.
std::vector<TrialKey> begin(const MakePlan& plan, const std::function<std::uint64_t()>& entropy) {
  const std::vector<TrialKey> keys = draw_keys(plan.draw, entropy);
  for (const fs::path& folder : {plan.data, plan.keys}) {
    if (holds_something(folder))
      throw InputError(folder.string(), "is not empty; give another folder, or --resume to go on with its trials");
    io::make_output_folder(folder);
  }
  io::write_text(plan.keys / kPlanFile, plan_text(plan));
  for (const TrialKey& key : keys) io::write_text(key_path(plan.keys, key.name), key_text(key));
  io::write_text(plan.data / kSealsFile, seals_text(keys));
  return keys;
}

// The plan is the first that is written; a call may have been killed even in that.
bool are_ours(const fs::path& keys) {
  return fs::exists(keys / kPlanFile) || fs::exists(keys / (std::string(kPlanFile) + ".part"));
}

// What an earlier call wrote, by its names, finished or not.
void remove_trials(const MakePlan& plan) {
  const auto is_ours = [](const std::string& name) {
    return name.starts_with(kSealsFile) || name.starts_with(kPlanFile) ||
           (name.size() > 3 &&
            std::all_of(name.begin(), name.begin() + 4, [](char c) { return c >= '0' && c <= '9'; }));
  };
  for (const fs::path& folder : {plan.data, plan.keys}) {
    std::error_code error;
    std::vector<fs::path> ours;
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (is_ours(entry.path().filename().string())) ours.push_back(entry.path());
    for (const fs::path& path : ours) fs::remove_all(path);
  }
}

std::vector<TrialKey> go_on(const MakePlan& plan) {
  if (io::read_text(plan.keys / kPlanFile, "the plan of trials", 4) != plan_text(plan))
    throw InputError(plan.keys.string(),
                     "is of other trials than are asked for; give the same options, or other folders");
  std::vector<TrialKey> keys;
  for (OpenedKey& opened : open_keys(plan.data, plan.keys)) {
    if (!opened.sealed)
      throw InputError(key_path(plan.keys, opened.key.name).string(), "is not the key that was sealed; begin afresh");
    keys.push_back(std::move(opened.key));
  }
  return keys;
}

}  // namespace

void make_trials(const MakePlan& plan, const std::function<std::uint64_t()>& entropy, IfThere if_there,
                 const Progress& progress) {
  // Keys whose seals were not published yet bind nobody.
  const bool go = if_there == IfThere::kResume && fs::exists(plan.data / kSealsFile);
  if (!go && if_there != IfThere::kRefuse && are_ours(plan.keys)) remove_trials(plan);
  const std::vector<TrialKey> keys = go ? go_on(plan) : begin(plan, entropy);
  std::vector<const TrialKey*> left;
  for (const TrialKey& key : keys)
    if (!fs::exists(plan.data / key.name)) left.push_back(&key);

  diagnose::in_turns(left.size(), progress, [&](std::size_t i, const Progress& own) {
    const fs::path folder = plan.data / left[i]->name;
    try {
      write_trial(plan.lab, *left[i], folder, own);
    } catch (const Interrupted&) {
      throw;
    } catch (const WorkError& e) {  // what failed, not what is in it
      throw WorkError(folder.string(), e.what());
    }
  });
}

}  // namespace tumble::trials
