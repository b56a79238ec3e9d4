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

constexpr std::size_t kWordsPerPiece = 8192;

// Archives go through a state word by word: one counts, one tells, one reads. A column has a word for each ball, in the
// order of the balls' numbers.
struct Counter {
  static constexpr bool kReads = false;
  std::size_t words = 0;
  void operator()(double) { ++words; }
  void operator()(std::int64_t) { ++words; }
  void operator()(const std::vector<double>& values) { words += 1 + values.size(); }
  void column(const std::vector<double>& values) { (*this)(values); }
};

class Teller {
 public:
  static constexpr bool kReads = false;
  Teller(const TakeWords& take, const std::vector<int>& id) : take_(take) {
    piece_.reserve(kWordsPerPiece);
    if (std::is_sorted(id.begin(), id.end())) return;
    place_.resize(id.size());
    for (std::size_t p = 0; p < id.size(); ++p) place_[static_cast<std::size_t>(id[p])] = static_cast<int>(p);
  }
  void operator()(double value) {
    piece_.push_back(value);
    if (piece_.size() == kWordsPerPiece) flush();
  }
  void operator()(std::int64_t value) { (*this)(std::bit_cast<double>(value)); }
  void operator()(const std::vector<double>& values) {
    (*this)(static_cast<std::int64_t>(values.size()));
    for (const double v : values) (*this)(v);
  }
  void column(const std::vector<double>& values) {
    if (place_.empty()) return (*this)(values);
    (*this)(static_cast<std::int64_t>(values.size()));
    for (const int p : place_) (*this)(values[static_cast<std::size_t>(p)]);
  }
  void flush() {
    take_(piece_);
    piece_.clear();
  }

 private:
  const TakeWords& take_;
  std::vector<double> piece_;
  std::vector<int> place_;  // by number; empty where the balls lie in that order
};

class Reader {
 public:
  static constexpr bool kReads = true;
  explicit Reader(const StoredCheckpoint& from) : from_(from), left_(from.size) {}
  void operator()(double& value) {
    if (at_ == piece_.size()) fetch();
    value = piece_[at_++];
  }
  void operator()(std::int64_t& value) {
    double word = 0;
    (*this)(word);
    value = std::bit_cast<std::int64_t>(word);
  }
  void operator()(std::vector<double>& values) {
    std::int64_t n = 0;
    (*this)(n);
    if (n < 0 || static_cast<std::size_t>(n) > left_ + (piece_.size() - at_))
      throw InputError("checkpoint", "is damaged; start afresh");
    values.resize(static_cast<std::size_t>(n));
    for (double& v : values) (*this)(v);
  }
  void column(std::vector<double>& values) { (*this)(values); }

 private:
  void fetch() {
    if (left_ == 0) throw InputError("checkpoint", "is too short for this run; start afresh");
    piece_.resize(std::min(left_, kWordsPerPiece));
    from_.next(piece_);
    left_ -= piece_.size();
    at_ = 0;
  }

  const StoredCheckpoint& from_;
  std::size_t left_;  // words not yet fetched
  std::vector<double> piece_;
  std::size_t at_ = 0;
};

template <class Archive, class Integer>
void visit_as_int64(Archive& archive, Integer& value) {
  auto wide = static_cast<std::int64_t>(value);
  archive(wide);
  if constexpr (Archive::kReads) value = static_cast<Integer>(wide);
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
  for (auto* v : moving_columns(c)) archive.column(*v);
  archive.column(run.mill.flights.apex);
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

std::size_t count_contacts(const RunningMill& mill, Kind kind) {
  std::size_t count = 0;
  for (const Patch& patch : mill.patches)
    count += static_cast<std::size_t>(patch.touching[static_cast<std::size_t>(kind)].size());
  return count;
}

void tell_contacts(Teller& teller, const RunningMill& mill, Kind kind) {
  teller(static_cast<std::int64_t>(count_contacts(mill, kind)));
  for_contacts(mill, kind, [&](Contact c) {
    for (const int v : {c.i, c.j, int{c.place}}) teller(std::int64_t{v});
    for (const double* v : words_in(c.state)) teller(*v);
    for (const double* v : words_in(c.terms)) teller(*v);
  });
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

Checkpoint checkpoint_of(const RunState& run) {
  // `visit` is written for both directions; these archives change nothing.
  auto& state = const_cast<RunState&>(run);
  Counter counter;
  visit(counter, state);
  for (const Kind kind : kAllKinds) counter.words += 1 + kWordsPerContact * count_contacts(run.mill, kind);
  return {run.frames_written, counter.words, [&state](const TakeWords& take) {
            Teller teller(take, state.mill.charge.id);
            visit(teller, state);
            for (const Kind kind : kAllKinds) tell_contacts(teller, state.mill, kind);
            teller.flush();
          }};
}

void restore(RunState& run, const StoredCheckpoint& stored) {
  const std::size_t balls = run.mill.charge.size();
  sort_by_number(run.mill);
  Reader reader(stored);
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
