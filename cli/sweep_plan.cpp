#include "cli/sweep_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "cli/console.h"
#include "diagnose/campaign.h"
#include "io/config_file.h"

namespace tumble::cli {
namespace fs = std::filesystem;
namespace {

constexpr double kTaskSeconds = 20;  // a task by itself costs half a second
constexpr double kFewTasks = 16;     // a short sweep is spread over so many

nlohmann::json json_of(const SweepPlan& plan) {
  auto varied = nlohmann::json::array();
  for (const VariedKey& v : plan.sweep.varied) varied.push_back({v.key, v.values});
  return {{"mill", plan.sweep.mill_toml},
          {"varied", varied},
          {"first_seed", plan.sweep.first_seed},
          {"repeats", plan.sweep.repeats}};
}

SweepPlan plan_of(const nlohmann::json& j) {
  SweepPlan plan;
  plan.sweep.mill_toml = j.at("mill");
  for (const auto& v : j.at("varied")) plan.sweep.varied.push_back({v.at(0), v.at(1)});
  plan.sweep.first_seed = j.at("first_seed");
  plan.sweep.repeats = j.at("repeats");
  plan.mill = io::parse_config(plan.sweep.mill_toml, "the mill of a sweep");
  return plan;
}

}  // namespace

std::vector<std::string> SweepPlan::sets_at(std::size_t run) const {
  std::vector<std::string> sets;
  const auto index = sweep.at(run / sweep.repeats);
  for (std::size_t k = 0; k < index.size(); ++k)
    sets.push_back(sweep.varied[k].key + "=" + sweep.varied[k].values[index[k]]);
  sets.push_back(fmt::format("run.seed={}", sweep.first_seed + run % sweep.repeats));
  return sets;
}

Config SweepPlan::config_of(std::size_t run) const { return io::with_sets(mill, sets_at(run)); }

bool has_auto_spin_up(const SweepPlan& plan) {
  for (std::size_t p = 0; p < plan.sweep.points(); ++p)
    if (plan.config_of(p * plan.sweep.repeats).run.spin_up_auto) return true;
  return false;
}

double seconds_of(const SweepPlan& plan) {
  const auto seconds_for = [&](double revolutions) {
    Config probe = plan.config_of(0);
    probe.run.spin_up_auto = false;
    probe.run.spin_up = 0;
    probe.run.revolutions = revolutions;
    const std::clock_t start = std::clock();  // the processor's: others at work on the machine do not show
    diagnose::run_once(probe, [](double) { stop_if_asked("nothing was written"); });
    return double(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const auto work = [](const Config& c, double revolutions) {  // balls x simulated seconds
    double balls = 0;
    for (const int n : class_counts(c)) balls += n;
    return balls * revolutions * 60 / speed_rpm(c.mill);
  };
  constexpr double kShort = 0.05, kLong = 0.25, kAutoSpinUp = 30;
  const double begin = seconds_for(kShort);
  const double each = std::max(0.0, seconds_for(kLong) - begin) / work(plan.config_of(0), kLong - kShort);
  double total = 0;
  for (std::size_t p = 0; p < plan.sweep.points(); ++p) {
    const Config c = plan.config_of(p * plan.sweep.repeats);
    total += (begin + each * work(c, (c.run.spin_up_auto ? kAutoSpinUp : c.run.spin_up) + c.run.revolutions)) *
             double(plan.sweep.repeats);
  }
  return total;
}

void TasksJournals::add_to(io::RunJournal& journal) {
  std::error_code none;  // there may be no such folder, and files may go while we look
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_, none)) {
    if (!entry.path().extension().string().starts_with(".task-")) continue;
    std::uintmax_t& read = read_[entry.path()];
    if (entry.file_size(none) != read) journal.take(entry.path(), read);
  }
}

void sweep_by_slurm(const SweepPlan& plan, io::RunJournal& journal, const fs::path& queue, int threads,
                    const Progress& progress) {
  TasksJournals tasks(queue);
  tasks.add_to(journal);
  std::vector<std::pair<std::size_t, std::uint64_t>> left;  // runs with their names in the journal
  for (std::size_t run = 0; run < plan.runs(); ++run)
    left.emplace_back(run, io::RunJournal::key_of(plan.config_of(run)));
  SlurmWork work{queue, "sweep", json_of(plan), plan.runs()};
  work.left = [&] {
    tasks.add_to(journal);
    std::erase_if(left, [&](const auto& run) { return journal.has(run.second); });
    std::vector<std::size_t> runs;
    for (const auto& run : left) runs.push_back(run.first);
    return runs;
  };
  if (work.left().empty()) return;
  const double each = seconds_of(plan) / double(plan.runs());
  work.per_task =
      static_cast<std::size_t>(std::max(1.0, std::min(kTaskSeconds / each, double(plan.runs()) / kFewTasks)));
  work.threads = std::max(1, threads);
  do_by_slurm(work, progress);
}

void sweep_task(const SlurmTask& task) {
  const SweepPlan plan = plan_of(task.plan);
  const auto config_of = [&](std::size_t i) { return plan.config_of(task.pieces[i]); };
  io::RunJournal journal(task.own, true);
  diagnose::CampaignSink sink;
  sink.known = [&](std::size_t i, RunOutcome& outcome) { return journal.find(config_of(i), outcome); };
  sink.finished = [&](std::size_t, const Config& config, const RunOutcome& outcome) { journal.add(config, outcome); };
  sink.progress = [](double) { stop_if_asked("the finished runs are kept"); };
  diagnose::run_campaign(task.pieces.size(), config_of, sink);
}

}  // namespace tumble::cli
