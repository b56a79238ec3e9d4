#include "sim/run_state.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "core/error.h"
#include "sim/ball_order.h"

namespace tumble::sim {
namespace {

// Contacts that can touch at once: discs in the plane make at most 3 n pairs (a planar graph); a ball touches the plate
// and a few runs of lifters. Some more for balls that overlap, and for a few balls in a hook of many runs.
constexpr std::size_t kPairsPerBall = 4, kFeaturesPerBall = 4;
constexpr std::size_t kWordsPerContact = 12;
constexpr std::size_t kArraysOfBalls = 14;  // charge, flights and locked balls, see `visit`
constexpr std::size_t kOtherWords = 64 + 64 * kWordsPerContact + 6 * kBins + 2 * kPlaces + kFallBins;

struct Writer {
  std::vector<double> words;
  void operator()(double& value) { words.push_back(value); }
  void operator()(const std::int64_t& value) { words.push_back(std::bit_cast<double>(value)); }
  void operator()(std::vector<double>& values) {
    auto n = static_cast<std::int64_t>(values.size());
    (*this)(n);
    words.insert(words.end(), values.begin(), values.end());
  }
};

struct Reader {
  const std::vector<double>& words;
  std::size_t at = 0;
  double next() {
    if (at >= words.size()) throw InputError("checkpoint", "is too short for this run; start afresh");
    return words[at++];
  }
  void operator()(double& value) { value = next(); }
  void operator()(std::int64_t& value) { value = std::bit_cast<std::int64_t>(next()); }
  void operator()(std::vector<double>& values) {
    std::int64_t n = 0;
    (*this)(n);
    if (n < 0 || static_cast<std::size_t>(n) > words.size() - at)
      throw InputError("checkpoint", "is damaged; start afresh");
    values.assign(words.begin() + static_cast<std::ptrdiff_t>(at), words.begin() + static_cast<std::ptrdiff_t>(at) + n);
    at += static_cast<std::size_t>(n);
  }
};

template <class Archive, class Integer>
void visit_as_int64(Archive& archive, Integer& value) {
  auto wide = static_cast<std::int64_t>(value);
  archive(wide);
  value = static_cast<Integer>(wide);
}

template <class Archive>
void visit(Archive& archive, Sums& sums) {
  archive(sums.torque);
  archive(sums.torque_shear);
  archive(sums.torque_external);
  archive(sums.mass_moment);
  visit_as_int64(archive, sums.steps);
}

// One list for writing and reading, so that they cannot disagree.
template <class Archive>
void visit(Archive& archive, RunState& run) {
  Charge& c = run.mill.charge;
  for (auto* v : moving_columns(c)) archive(*v);
  archive(run.mill.flights.apex);
  archive(run.mill.step);
  archive(run.mill.fastest);

  Ledger& l = run.mill.ledger;
  archive(l.drive_work);
  for (double& d : l.dissipated) archive(d);
  Impacts& n = l.impacts;
  for (Spectrum* s : {&n.ball_ball, &n.ball_wall})
    for (auto* bins : {&s->total, &s->normal, &s->tangential})
      for (double& count : *bins) archive(count);
  for (auto* bins : {&n.wall_number, &n.wall_energy})
    for (double& count : *bins) archive(count);
  for (double& count : n.falls) archive(count);
  archive(n.lifter_number);
  archive(n.lifter_energy);
  visit_as_int64(archive, l.counting_impacts);

  for (auto* v : {&run.history.torque, &run.history.closure, &run.history.locked, &run.locked.home, &run.locked.since})
    archive(*v);
  visit_as_int64(archive, run.locked.count);
  visit(archive, run.frame);
  visit(archive, run.sample);
  archive(run.work_at_frame);
  archive(run.averaging_from);
  archive(run.sampled_before);
  archive(run.frames_written);
  visit_as_int64(archive, run.spin_up_gave_up);
}

std::array<double*, 5> words_in(ContactState& s) {
  return {&s.overlap, &s.dashpot, &s.spring, &s.normal_lost, &s.sliding_lost};
}
std::array<double*, 4> words_in(TermState& t) { return {&t.force, &t.stored, &t.damping, &t.roll}; }

void write_contacts(Writer& writer, const RunningMill& mill, Kind kind) {
  const std::vector<Contact> contacts = contacts_of(mill, kind);
  writer(static_cast<std::int64_t>(contacts.size()));
  for (Contact c : contacts) {
    for (const std::int64_t v : {c.i, c.j, int{c.place}}) writer(v);
    for (double* v : words_in(c.state)) writer(*v);
    for (double* v : words_in(c.terms)) writer(*v);
  }
}

void read_contacts(Reader& reader, RunningMill& mill, Kind kind) {
  const Charge& charge = mill.charge;
  const auto balls = static_cast<std::int64_t>(charge.size());
  const std::int64_t others = kind == Kind::kBalls ? balls : feature_count(mill.model.shell);
  std::int64_t contacts = 0;
  reader(contacts);
  for (std::int64_t k = 0; k < contacts; ++k) {
    std::int64_t i = 0, j = 0, place = 0;
    Contact c;
    for (std::int64_t* v : {&i, &j, &place}) reader(*v);
    for (double* v : words_in(c.state)) reader(*v);
    for (double* v : words_in(c.terms)) reader(*v);
    if (i < 0 || i >= balls || j < 0 || j >= others || place < 0 || place >= kPlaces)
      throw InputError("checkpoint", "is damaged; start afresh");
    c.i = static_cast<int>(i);
    c.j = static_cast<int>(j);
    c.place = static_cast<std::uint16_t>(place);
    const double mass = charge.mass[static_cast<std::size_t>(i)];
    if (kind == Kind::kBalls) {
      const double other = charge.mass[static_cast<std::size_t>(j)];
      c.damping = mill.damping[0].of(mass * other / (mass + other));
    } else {
      c.damping = mill.damping[1].of(mass);
    }
    add(mill.patches[0].touching[static_cast<std::size_t>(kind)], c, kind, mill.model.plain());
    ++mill.flights.contacts[static_cast<std::size_t>(i)];
    if (kind == Kind::kBalls) ++mill.flights.contacts[static_cast<std::size_t>(j)];
  }
}

constexpr Kind kAllKinds[] = {Kind::kBalls, Kind::kPlate, Kind::kLifters};

}  // namespace

std::vector<double> words_of(const RunState& run) {
  Writer writer;
  RunState copy = run;  // `visit` is written for both directions and wants to change what it sees
  sort_by_number(copy.mill);
  visit(writer, copy);
  for (const Kind kind : kAllKinds) write_contacts(writer, run.mill, kind);
  return std::move(writer.words);
}

void restore(RunState& run, const std::vector<double>& words) {
  const std::size_t balls = run.mill.charge.size();
  sort_by_number(run.mill);
  Reader reader{words};
  visit(reader, run);
  bool fits = run.mill.flights.apex.size() == balls;
  for (const std::vector<double>* v : moving_columns(run.mill.charge)) fits = fits && v->size() == balls;
  if (!fits) throw InputError("checkpoint", "holds another number of balls than the config; start afresh");
  const Impacts& impacts = run.mill.ledger.impacts;
  const auto lifters = static_cast<std::size_t>(run.mill.model.shell.lifter_count);
  const History& h = run.history;
  if (h.closure.size() != h.size() || h.locked.size() != h.size() ||
      run.locked.since.size() != run.locked.home.size() || run.sampled_before < 0 ||
      impacts.lifter_number.size() != lifters || impacts.lifter_energy.size() != lifters ||
      static_cast<std::size_t>(run.sampled_before) > h.size())
    throw InputError("checkpoint", "is damaged; start afresh");
  // How many contacts each ball has is not kept: it follows from the contacts.
  std::fill(run.mill.flights.contacts.begin(), run.mill.flights.contacts.end(), 0);
  for (Patch& patch : run.mill.patches) patch.touching = {};
  for (const Kind kind : kAllKinds) read_contacts(reader, run.mill, kind);
  run.mill.stale = true;
}

std::size_t most_words(std::size_t balls, std::size_t samples, std::size_t lifters) {
  return 2 * lifters + balls * (kArraysOfBalls + kWordsPerContact * (kPairsPerBall + kFeaturesPerBall)) + 3 * samples +
         kOtherWords;
}

}  // namespace tumble::sim
