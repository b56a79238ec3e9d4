#include "cli/signature_library.h"

#include <algorithm>
#include <cmath>

#include "cli/console.h"
#include "core/error.h"
#include "diagnose/library_chunks.h"
#include "io/chunk_store.h"
#include "io/config_file.h"
#include "io/config_keys.h"

namespace tumble::cli {
namespace fs = std::filesystem;
namespace {

using Chunks = std::vector<diagnose::LibraryChunk>;

Config mill_with(const Config& config, const std::vector<std::string>& sets) { return io::with_sets(config, sets); }

std::vector<io::ChunkStore> stores_of(const LibraryPlan& plan, const std::vector<diagnose::Condition>& conditions) {
  std::vector<io::ChunkStore> stores;
  for (const diagnose::Condition& c : conditions) stores.emplace_back(plan.folder, c.definition);
  return stores;
}

std::size_t build(const LibraryPlan& plan, std::vector<diagnose::Condition>& conditions, const Chunks& chunks,
                  const Progress& progress) {
  const std::vector<io::ChunkStore> stores = stores_of(plan, conditions);
  diagnose::LibrarySink sink;
  sink.read = [&](std::size_t c, std::size_t chunk, auto& rows) { return stores[c].read(chunk, rows); };
  sink.write = [&](std::size_t c, std::size_t chunk, const auto& rows) { stores[c].write(chunk, rows); };
  sink.progress = progress;
  return diagnose::build_chunks(conditions, plan.uncertain, chunks, mill_with, sink);
}

nlohmann::json json_of(const LibraryPlan& plan) {
  auto mills = nlohmann::json::array(), uncertain = nlohmann::json::array();
  for (const Config& mill : plan.mills) mills.push_back(io::to_toml(mill));
  for (const UncertainKey& u : plan.uncertain) uncertain.push_back({u.key, u.sd});
  return {{"folder", fs::absolute(plan.folder)}, {"blocks", plan.blocks}, {"uncertain", uncertain}, {"mills", mills}};
}

LibraryPlan plan_of(const nlohmann::json& j) {
  LibraryPlan plan{j.at("folder").get<std::string>(), j.at("blocks"), {}, {}};
  for (const auto& u : j.at("uncertain")) plan.uncertain.push_back({u.at(0), u.at(1), u.at(0)});
  for (const auto& mill : j.at("mills")) plan.mills.push_back(io::parse_config(mill, "the mill of an experiment"));
  return plan;
}

}  // namespace

std::vector<double> values_of(const Config& mill, const std::vector<UncertainKey>& uncertain) {
  std::vector<double> values;
  for (const UncertainKey& u : uncertain) {
    values.push_back(io::number_at(mill, u.key));
    if (std::isnan(values.back()))
      throw InputError(u.place,
                       "is uncertain about a value that MILL.toml does not give; give it there, or remove this");
  }
  return values;
}

std::vector<diagnose::Condition> conditions_of(const LibraryPlan& plan) {
  std::vector<diagnose::Condition> conditions;
  for (const Config& mill : plan.mills)
    conditions.push_back(diagnose::make_condition(mill, plan.uncertain, values_of(mill, plan.uncertain),
                                                  io::to_toml(diagnose::bare(mill))));
  return conditions;
}

std::size_t build_library(const LibraryPlan& plan, std::vector<diagnose::Condition>& conditions,
                          const Progress& progress) {
  return build(plan, conditions, diagnose::plan_chunks(conditions, plan.uncertain, plan.blocks), progress);
}

std::size_t make_library_by_slurm(const LibraryPlan& plan, const fs::path& queue, int threads,
                                  const Progress& progress) {
  const std::vector<diagnose::Condition> conditions = conditions_of(plan);
  const std::vector<io::ChunkStore> stores = stores_of(plan, conditions);
  const Chunks chunks = diagnose::plan_chunks(conditions, plan.uncertain, plan.blocks);
  SlurmWork work{queue, "library", json_of(plan), chunks.size()};
  work.threads = std::max(1, threads);
  work.left = [&] {
    std::vector<std::size_t> left;
    for (std::size_t i = 0; i < chunks.size(); ++i)
      if (!stores[chunks[i].condition].has(chunks[i].number)) left.push_back(i);
    return left;
  };
  std::size_t simulations = 0;
  for (const std::size_t i : work.left()) simulations += chunks[i].count;
  if (simulations > 0) do_by_slurm(work, progress);
  return simulations;
}

void library_task(const SlurmTask& task) {
  const LibraryPlan plan = plan_of(task.plan);
  std::vector<diagnose::Condition> conditions = conditions_of(plan);
  const Chunks all = diagnose::plan_chunks(conditions, plan.uncertain, plan.blocks);
  Chunks own;
  for (const std::size_t piece : task.pieces) own.push_back(all.at(piece));
  build(plan, conditions, own, [](double) { stop_if_asked("the finished runs are kept"); });
}

}  // namespace tumble::cli
