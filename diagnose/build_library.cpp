#include "diagnose/build_library.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <mutex>

#include "core/error.h"
#include "core/fingerprint.h"
#include "diagnose/in_turns.h"
#include "diagnose/library_chunks.h"

namespace tumble::diagnose {
namespace {

// Raised whenever the same mill would give other numbers, or others than before: old libraries are then of no use.
constexpr int kVersionOfSignatures = 6;
constexpr std::size_t kChunk = 8;  // runs of a file
constexpr int kMostRetreats = 8;

struct Run {
  Config config;
  std::vector<double> uncertain;
  double strength = 0;
};

// A value that no mill can have (a restitution above 1) gives way to one nearer to the middle.
Run mill_of(const Condition& condition, const std::vector<UncertainKey>& keys, const SignatureAsked& asked,
            const MillWith& mill_with) {
  Run run{{}, asked.uncertain, asked.strength};
  std::vector<std::string> fixed;
  if (asked.suspect >= 0) {
    const Suspect& suspect = condition.suspects[static_cast<std::size_t>(asked.suspect)];
    fixed = sets_at(suspect, asked.strength);
    run.strength = strength_of_sets(suspect, asked.strength);
  }
  for (int retreat = 0;; ++retreat) {
    std::vector<std::string> sets;
    for (std::size_t k = 0; k < keys.size(); ++k)
      sets.push_back(fmt::format("{}={}", keys[k].key, condition.middle[k] + run.uncertain[k] * keys[k].sd));
    sets.insert(sets.end(), fixed.begin(), fixed.end());
    try {
      run.config = mill_with(condition.config, sets);
      run.config.run.seed = asked.seed ^ fingerprint(condition.definition);
      return run;
    } catch (const InputError&) {
      if (retreat == kMostRetreats) throw;
      for (double& u : run.uncertain) u *= kRetreat;
    }
  }
}

}  // namespace

Condition make_condition(const Config& config, const std::vector<UncertainKey>& uncertain, std::vector<double> middle,
                         const std::string& toml) {
  Condition condition{config, suspects_of(config), std::move(middle), {}, {}, 0};
  condition.definition = fmt::format("signatures {}\n{}", kVersionOfSignatures, toml);
  for (std::size_t k = 0; k < uncertain.size(); ++k)
    condition.definition += fmt::format("uncertain {} {} {}\n", uncertain[k].key, condition.middle[k], uncertain[k].sd);
  for (const Suspect& s : condition.suspects) {
    condition.definition += fmt::format("suspect {} {} {} {}", s.name, s.variant, s.low, s.high);
    for (const std::string& set : sets_at(s, 1)) condition.definition += " " + set;
    condition.definition += "\n";
  }
  return condition;
}

std::vector<LibraryChunk> plan_chunks(const std::vector<Condition>& conditions,
                                      const std::vector<UncertainKey>& uncertain, std::size_t blocks) {
  std::vector<LibraryChunk> chunks;
  for (std::size_t b = 0; b < blocks; ++b)
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const std::size_t runs = plan_block(b, uncertain.size(), conditions[c].suspects).size();
      const std::size_t per_block = (runs + kChunk - 1) / kChunk;
      for (std::size_t k = 0; k < per_block; ++k)
        chunks.push_back({c, b, k * kChunk, std::min(kChunk, runs - k * kChunk), b * per_block + k});
    }
  return chunks;
}

std::size_t build_chunks(std::vector<Condition>& conditions, const std::vector<UncertainKey>& uncertain,
                         const std::vector<LibraryChunk>& chunks, const MillWith& mill_with, const LibrarySink& sink) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<SignatureAsked>> asked;  // by condition and block
  for (const LibraryChunk& chunk : chunks)
    if (auto& block = asked[{chunk.condition, chunk.block}]; block.empty())
      block = plan_block(chunk.block, uncertain.size(), conditions[chunk.condition].suspects);
  std::vector<std::vector<SignatureRun>> done(chunks.size());
  std::mutex filing;
  std::size_t simulated = 0;
  in_turns(chunks.size(), sink.progress, [&](std::size_t i, const Progress& own) {
    const LibraryChunk& chunk = chunks[i];
    const Condition& condition = conditions[chunk.condition];
    const ObservationLayout layout(condition.config.mill.lifters.count);
    std::vector<std::vector<float>> rows;
    {
      const std::lock_guard lock(filing);
      if (sink.read && !sink.read(chunk.condition, chunk.number, rows)) rows.clear();
    }
    const bool known = rows.size() == chunk.count;
    std::vector<std::vector<float>> fresh;
    for (std::size_t k = 0; k < chunk.count; ++k) {
      const SignatureAsked& a = asked.at({chunk.condition, chunk.block})[chunk.first + k];
      const Run mill = mill_of(condition, uncertain, a, mill_with);
      SignatureRun run;
      if (known) {
        if (!unpack(rows[k], layout, run)) run.error = "failed before";
      } else {
        run = run_signature(mill.config, condition.config,
                            [&](double share) { report(own, (double(k) + share) / double(chunk.count)); });
        run.strength = mill.strength;
        fresh.push_back(pack(run));
        if (run.error.empty()) unpack(fresh.back(), layout, run);  // as it will be read: the same verdict either way
      }
      run.condition = chunk.condition;
      run.uncertain = mill.uncertain;
      run.suspect = a.suspect;
      run.strength = mill.strength;
      run.seed = mill.config.run.seed;
      done[i].push_back(std::move(run));
    }
    if (known) return;
    const std::lock_guard lock(filing);
    simulated += chunk.count;
    if (sink.write) sink.write(chunk.condition, chunk.number, fresh);
  });

  for (std::size_t i = 0; i < chunks.size(); ++i)
    for (SignatureRun& run : done[i]) {
      Condition& condition = conditions[chunks[i].condition];
      if (run.error.empty())
        condition.runs.push_back(std::move(run));
      else
        ++condition.failed;
    }
  return simulated;
}

std::size_t build_library(std::vector<Condition>& conditions, const std::vector<UncertainKey>& uncertain,
                          std::size_t blocks, const MillWith& mill_with, const LibrarySink& sink) {
  return build_chunks(conditions, uncertain, plan_chunks(conditions, uncertain, blocks), mill_with, sink);
}

}  // namespace tumble::diagnose
