#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/body_effects.h"
#include "sim/exact_sum.h"
#include "sim/laws/contact_model.h"
#include "sim/lifter_run.h"

// The loops that a run spends its time in, for contacts and balls side by side in SIMD lanes. Each exists for every
// instruction set that is worth it and is chosen when the program starts. All give the same bits: the operations of a
// lane are those of a double, and sums are exact (sim/exact_sum.h).
namespace tumble::sim {

// The balls' arrays, see sim/charge.h.
struct ChargeView {
  double *x, *y, *angle, *vx, *vy, *spin, *ax, *ay, *alpha;
  const double *radius, *mass, *half_step_per_mass, *half_step_per_inertia;
  double *end_x, *end_y, *apex;
};

// What the contacts of one list remember. Groups of kGroup contacts lie one behind the other, as one stream through the
// memory; in a group, column by column. `i` and `j` are the two bodies: ball and ball, or ball and feature.
inline constexpr int kGroup = 8;
enum Column { kDamping, kOverlap, kDashpot, kSpring, kNormalLost, kSlidingLost, kForce, kStored, kTermDamping, kRoll };
inline constexpr int kPlainColumns = 6, kAllColumns = 10;  // those of a model that is not plain come last
struct ContactColumns {
  const int *i, *j;  // with room for whole groups
  double* numbers;
  int columns;
  double* of(int k) const { return numbers + (k / kGroup * kGroup * columns + k % kGroup); }
};

// Steps of the exact sums of a mill.
struct ExactSums {
  ExactSum force, moment, torque, loss, energy, mass_moment;
};

struct WallMotion {
  double shell_radius = 0;  // R [m]
  double speed_before = 0;  // Omega in the middle of the step that led here [rad/s]
  double faster = 0;        // what it has gained since then [rad/s]
};

// The lifters' outline where all lifters have the same, convex one: in lanes. See sim/shell.h.
inline constexpr int kMostFaces = 8;
struct ConvexLifters {
  int faces = 0;  // 0: not such a shell
  double x[kMostFaces], y[kMostFaces], tx[kMostFaces], ty[kMostFaces], nx[kMostFaces], ny[kMostFaces],
      length[kMostFaces];
  const double *cos = nullptr, *sin = nullptr;  // direction of each feature at this step, from feature 1 on
};

// The lifters' outlines of any shape, which may differ from lifter to lifter. See sim/shell.h.
struct LifterRuns {
  const LifterFace* faces = nullptr;
  const FaceCorners* corners = nullptr;
  const FaceBlock* blocks = nullptr;
  const Run* runs = nullptr;
  int count = 0;                                // of the runs
  const double* run_of = nullptr;               // of each feature, from feature 0 on
  const double *cos = nullptr, *sin = nullptr;  // direction of each feature at this step, from feature 1 on
  double out_of_sight = 0;                      // distance that is given where a ball is not reached [m]
};

// All that the contacts of one kind have in common at one step.
struct ContactStep {
  const ContactModel* law = nullptr;
  const ChargeView* balls = nullptr;
  const ExactSums* exact = nullptr;
  double time_step = 0;  // [s]
  WallMotion wall;       // for contacts with the wall
  const ConvexLifters* lifters = nullptr;
};

inline constexpr int kBlock = 64;  // contacts that are worked out at a time

// Nearest points of the wall for a block of contacts.
struct WallPoints {
  alignas(64) double distance[kBlock], nx[kBlock], ny[kBlock];
};

// Force and moment on a ball and what presses on it lie in a row: F_x, F_y [N], M [N m], sum |F_n| [N].
inline constexpr int kRow = 4;

// What a block of contacts does to its balls. Contacts that have come apart push nothing; their memory is as it was.
struct Pushes {
  alignas(64) double on_i[kRow * kBlock], on_j[kRow * kBlock];
  std::uint64_t parted = 0;    // bit k: contact k has come apart
  std::uint64_t too_deep = 0;  // bit k: contact k overlaps by more than half a radius
};

struct ContactSums {
  double normal_loss = 0, sliding_loss = 0, rolling_loss = 0;  // [J]
  double torque = 0, torque_shear = 0;                         // on the mill, of contacts with the wall [N m]
  void add(const ContactSums& s) {
    normal_loss += s.normal_loss;
    sliding_loss += s.sliding_loss;
    rolling_loss += s.rolling_loss;
    torque += s.torque;
    torque_shear += s.torque_shear;
  }
};

// What acts on all balls during a kick besides their contacts.
struct KickTerms {
  const BodyEffects* body = nullptr;
  double time_step = 0, gravity = 0;
  double cos = 1, sin = 0;  // of the mill's angle
  double speed_before = 0;  // of the mill in the middle of the step before [rad/s]
};

struct KickSums {
  double fastest2 = 0;     // largest square of a speed [m2/s2]
  double mass_moment = 0;  // sum of m x [kg m]
  double ends_torque = 0, ends_loss = 0;
  double drag_loss = 0, pool_loss = 0, external = 0;
  bool finite = true;
  void add(const KickSums& s);
};

// The row of ball i is number i & mask: a power of two of rows, whole batches of lanes, that the balls go through.
struct ForceView {
  double* rows;
  int mask = 0;
};

// The balls in the order of the cells of a grid. Readable for kMostLanes beyond the end.
inline constexpr int kMostLanes = 8;
struct GridView {
  const double *x, *y, *radius;
};

// Ranges are [first, last).
struct Kernels {
  const char* name;

  // Pairs (p, q) of one ball p with the balls [first, last) of the grid that are nearer than touching + skin and not
  // larger than p (`smaller`: strictly) into `out_p`, `out_q`, with room for kMostLanes more; how many.
  int (*near_of)(const GridView&, int p, int first, int last, double skin, bool smaller, int* out_p, int* out_q);

  // Gap between the surfaces of the balls p and q of n pairs; negative, where they touch.
  void (*gaps)(const GridView&, const int* p, const int* q, int n, double* gap);

  // Those of the n pairs (i, j) that touch, into `hits`, with room for kMostLanes more; how many.
  int (*touching_pairs)(const ChargeView&, const int* i, const int* j, int n, int* hits);
  // Likewise, of the balls i that touch the shell's circle.
  int (*touching_plate)(const ChargeView&, double shell_radius, const int* i, int n, int* hits);
  // Likewise, of the balls i that touch the convex lifters j.
  int (*touching_lifters)(const ChargeView&, const ConvexLifters&, const int* i, const int* j, int n, int* hits);

  // Where the balls i meet the runs j, n <= kBlock of them; out of sight where they do not touch. Returns the bits of
  // those that it cannot tell, for only the whole section can: balls behind a run.
  std::uint64_t (*nearest_on_runs)(const ChargeView&, const LifterRuns&, const int* i, const int* j, int n,
                                   WallPoints&);

  // The next step of contacts that have touched before. All of them in one block: k / kBlock is the same. `points` are
  // not looked at for convex lifters.
  void (*balls)(const ContactStep&, const ContactColumns&, int first, int last, Pushes&, ContactSums&);
  void (*plate)(const ContactStep&, const ContactColumns&, int first, int last, Pushes&, ContactSums&);
  void (*lifters)(const ContactStep&, const ContactColumns&, int first, int last, const WallPoints&, Pushes&,
                  ContactSums&);

  // Adds rows to those of the balls `at`.
  void (*scatter)(const double* rows, const int* at, int n, const ForceView&);

  void (*drift)(const ChargeView&, double time_step, int first, int last);
  // Sets the forces back to zero.
  void (*kick)(const ChargeView&, const KickTerms&, const ExactSums&, const ForceView&, int first, int last, KickSums&);
};

extern const Kernels kScalarKernels;  // on every machine
#if defined(__x86_64__)
extern const Kernels kAvx2Kernels, kAvx512Kernels;
#endif

// The best that this machine can run.
const Kernels& best_kernels();

// All that this machine can run, best first; the last is "scalar", which every machine can.
std::vector<const Kernels*> all_kernels();

}  // namespace tumble::sim
