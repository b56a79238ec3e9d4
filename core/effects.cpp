#include "core/effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace tumble {
namespace {

constexpr double kNone = kNotGiven;
using P = EffectParameter;

constexpr P strength(const char* name, const char* unit, double least, double most, double typical,
                     const char* meaning) {
  return {name, unit, least, most, kNone, meaning, typical, true, false, false};
}
constexpr P setting(const char* name, const char* unit, double least, double most, double otherwise,
                    const char* meaning) {
  return {name, unit, least, most, otherwise, meaning, otherwise, false, false, false};
}

constexpr std::array kRolling{
    strength("coefficient", "", 0, 1, 0.02, "mu_r: couple at the limit over (normal force x effective radius)")};

constexpr std::array kWeakening{
    strength("drop", "", 0, 1, 0.4, "share of the friction that is lost at high sliding speed"),
    setting("sliding_speed", "m/s", 1e-6, 1e3, 0.25, "v_s: speed over which it is lost")};

constexpr std::array kWallFriction{
    strength("increase", "", -1, 20, 0.5, "relative change of the friction between ball and wall; < 0 lowers it")};

constexpr std::array kDrag{
    strength("viscosity", "Pa s", 0, 1e4, 0.088, "eta of the fluid that fills the mill"),
    strength("density", "kg/m3", 0, 2e4, 0, "rho of the fluid, for the quadratic part"),
    setting("drag_coefficient", "", 0, 100, 0.44, "C_d of a sphere in the quadratic part (Newton's regime)")};

constexpr std::array kPool{
    strength("density", "kg/m3", 0, 2e4, 1500, "rho of the slurry"),
    setting("level", "R", -1, 1, -0.5, "height of the pool's surface against the axis, in shell radii"),
    setting("viscosity", "Pa s", 0, 1e4, 0.05, "eta of the slurry"),
    setting("drag_coefficient", "", 0, 100, 0.44, "C_d of a sphere in the quadratic part")};

constexpr std::array kRestitution{
    strength("drop", "", 0, 0.99, 0.4, "share of the restitution that is lost in fast impacts"),
    setting("impact_speed", "m/s", 1e-6, 1e3, 0.5, "v_e: normal speed over which it is lost")};

constexpr std::array kEnds{
    strength("coefficient", "", 0, 10, 0.05, "friction of both ends at slip over the ball's own weight"),
    strength("pressure", "", 0, 1, 0, "the same over the sum of the normal forces of the ball's contacts")};

constexpr std::array kCohesion{
    strength("force", "N", 0, 1e6, 0.6, "F_c: pull-off force of two balls of the charge's number-mean radius")};

constexpr std::array kWear{
    strength("height_loss", "", 0, 0.95, 0.3, "share of the lifter's height that is worn off"),
    strength("rounding", "m", 0, 1, 0.005, "radius of the rounded edges; what the section cannot hold is cut to fit"),
    P{"lifters", "", 0, 1e5, kNone, "numbers of the worn lifters; all where not given", kNone, false, true, true}};

constexpr std::array kHertz{
    strength("share", "", 0, 1, 1, "share of the normal force that grows with the overlap's power 3/2"),
    setting("reference_speed", "m/s", 1e-3, 100, 1,
            "impact speed at which two mean balls overlap as much as by the linear law")};

constexpr std::array kRipple{
    strength("amplitude", "", 0, 0.99, 0.1, "a: relative amplitude of the mill's speed"),
    P{"order", "1/rev", 1, 1000, 1, "n: ripples per revolution, a whole number", 1, false, false, true},
    setting("phase_deg", "deg", -360, 360, 0, "phase of the ripple at mill angle 0")};

constexpr std::array kMissing{
    P{"lifters", "", 0, 1e5, kNone, "numbers of the lifters that are not there", kNone, true, true, true}};

constexpr P column(const char* name, const char* unit, double least, double most, double typical, const char* meaning) {
  return {name, unit, least, most, kNone, meaning, typical, true, true, false};
}
constexpr P at_speeds(const char* meaning) {
  return {"speed", "m/s", 0, 1e3, kNone, meaning, kNone, false, true, false};
}

constexpr std::array kTabulatedFriction{
    at_speeds("v: sliding speeds of the contact, ascending"),
    column("friction", "", 0, 10, 0.2, "mu between balls at these speeds; contact.friction where not given"),
    column("wall_friction", "", 0, 10, 0.2, "mu at the wall at these speeds; contact.wall.friction where not given")};

constexpr std::array kTabulatedRestitution{
    at_speeds("v: normal speeds at the first touch, ascending"),
    column("restitution", "", 0.01, 1, 0.8, "e between balls at these speeds; contact.restitution where not given"),
    column("wall_restitution", "", 0.01, 1, 0.4,
           "e at the wall at these speeds; contact.wall.restitution where not given")};

constexpr std::array kTabulatedDrag{
    at_speeds("v: speeds of the ball in the lab, ascending"),
    column("coefficient", "kg/s", 0, 1e6, 0.02,
           "c = F / v of a ball of the charge's number-mean radius at these speeds"),
    P{"radius_power", "", 0, 3, 1, "n: 1 as Stokes' drag, 2 as Newton's, 3 the same deceleration for all", 1, false,
      false, true}};

const std::array kEffects{
    Effect{"rolling_resistance", "contact", "a couple that opposes rolling of ball on ball and ball on wall",
           "M = -k_r theta_r, |M| <= mu_r R |F_n|; k_r = k_t R^2, R = r_i r_j / (r_i + r_j), at the wall r",
           "Iwashita & Oda, J. Eng. Mech. 124 (1998) 285; Ai et al., Powder Technol. 206 (2011) 269, model C",
           kRolling},
    Effect{"friction_weakening", "contact", "friction that falls with the sliding speed of the contact",
           "mu(v_t) = mu (1 - drop (1 - exp(-v_t / v_s)))",
           "model; Moore, Principles and Applications of Tribology (1975), by Mishra & Rajamani 1992, p. 603",
           kWeakening},
    Effect{"wall_friction", "contact", "another friction at shell and lifters than the model's",
           "mu_wall -> mu_wall (1 + increase)",
           "model; friction of balls on liners as measured: Peng et al., Tribol. Trans. (2020), "
           "doi:10.1080/10402004.2020.1831120",
           kWallFriction},
    Effect{"fluid_drag", "ball", "drag and spin friction of a fluid at rest that fills the mill",
           "F = -(6 pi eta r + C_d rho pi r^2 |v| / 2) v; M = -8 pi eta r^3 omega",
           "Stokes 1851; Lamb, Hydrodynamics, arts 334, 337; Mishra & Rajamani 1992, p. 599", kDrag},
    Effect{"slurry_pool", "ball", "a level pool at rest in the lab: buoyancy, and drag inside it",
           "F_b = rho g V(h) upwards, V(h) = pi h^2 (3 r - h) / 3; drag and spin friction x V(h) / V(2 r)",
           "Archimedes; drag as fluid_drag", kPool},
    Effect{"impact_restitution", "contact", "restitution that falls with the normal speed of the impact",
           "e(v_n) = e (1 - drop (1 - exp(-v_n / v_e))), v_n at first touch",
           "model; plastic impact: Johnson, Contact Mechanics (1985), sec. 11.5", kRestitution},
    Effect{
        "end_wall_friction", "ball", "friction of the turning end walls of a slice on every ball",
        "F = -k_t s, |F| <= coefficient m g + pressure sum |F_n|; s slides against the ends, which turn with the shell",
        "Coulomb friction with history, Cundall & Strack 1979", kEnds},
    Effect{"cohesion", "contact", "attraction of touching bodies, as by wet slurry",
           "F_n -> F_n - F_c R / R_mean while they touch; friction limit mu |F_n + F_c|",
           "Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) 314 (pull-off force ~ R)", kCohesion},
    Effect{"lifter_wear", "shell", "lifters of lesser height with rounded edges, all or single ones",
           "height -> height (1 - height_loss); convex edges become arcs of radius `rounding`",
           "geometry; how lifters wear: Yahyaei & Banisi, Miner. Eng. 23 (2010) 1213", kWear},
    Effect{"hertz_contact", "contact", "stiffness that grows with the overlap (spheres; layers of particles between)",
           "F_n = (1 - share) k_n d + share k_h d^(3/2); k_h = (5/4) k_n d_0^(-1/2) (R / R_0)^(1/2), d_0 the overlap "
           "of two "
           "mean balls at reference_speed; damping keeps e at every speed",
           "Hertz 1882; Tsuji et al., Powder Technol. 71 (1992) 239; Antypov & Elliott, EPL 94 (2011) 50004", kHertz},
    Effect{"speed_ripple", "drive", "a mill speed that varies within the revolution",
           "theta = W t + (a / n) (sin(n W t + phase) - sin(phase)), W the mean speed",
           "kinematics of a drive with a tooth or coupling fault", kRipple},
    Effect{"missing_lifters", "shell", "lifters that have been lost", "the shell without the lifters listed",
           "geometry", kMissing},
    Effect{"tabulated_friction", "contact", "friction by a table against the sliding speed of the contact",
           "mu = mu(v_t), linear between the table's speeds and constant outside", "a measured law",
           kTabulatedFriction},
    Effect{"tabulated_restitution", "contact", "restitution by a table against the normal speed of the impact",
           "e = e(v_n), v_n at first touch; linear between the table's speeds and constant outside", "a measured law",
           kTabulatedRestitution},
    Effect{"tabulated_drag", "ball", "drag by a table against the ball's speed",
           "F = -c(|v|) (r / r_mean)^n v, c linear between the table's speeds and constant outside", "a measured law",
           kTabulatedDrag},
};

const EffectParameter& parameter_of(const std::string& name, const std::string& parameter) {
  const Effect* effect = find_effect(name);
  const EffectParameter* p = effect ? find_parameter(*effect, parameter) : nullptr;
  if (!p) throw std::logic_error("no effect parameter " + name + "." + parameter);
  return *p;
}

const std::vector<double>* given(const Config& config, const std::string& name, const std::string& parameter) {
  const auto effect = config.effects.find(name);
  if (effect == config.effects.end()) return nullptr;
  const auto value = effect->second.find(parameter);
  return value == effect->second.end() ? nullptr : &value->second;
}

}  // namespace

std::span<const Effect> all_effects() { return kEffects; }

const Effect* find_effect(const std::string& name) {
  const auto it = std::find_if(kEffects.begin(), kEffects.end(), [&](const Effect& e) { return name == e.name; });
  return it == kEffects.end() ? nullptr : &*it;
}

const EffectParameter* find_parameter(const Effect& effect, const std::string& name) {
  const auto it = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                               [&](const EffectParameter& p) { return name == p.name; });
  return it == effect.parameters.end() ? nullptr : &*it;
}

bool has_effect(const Config& config, const std::string& name) {
  const Effect* effect = find_effect(name);
  return effect && std::any_of(effect->parameters.begin(), effect->parameters.end(), [&](const EffectParameter& p) {
           const auto* values = p.strength ? given(config, name, p.name) : nullptr;
           return values && (p.list ? !values->empty() : values->front() != 0);
         });
}

double effect_value(const Config& config, const std::string& name, const std::string& parameter) {
  const EffectParameter& p = parameter_of(name, parameter);
  if (const auto* values = given(config, name, parameter)) return values->front();
  return std::isnan(p.otherwise) ? 0 : p.otherwise;
}

double friction_share(const Config& config) {
  return std::max(0.0, 1 - config.contact.friction_drop_at_critical * speed_fraction(config.mill));
}

double hertz_share(const Config& config) {
  return config.contact.law == ContactLaw::kHertz ? 1 : effect_value(config, "hertz_contact", "share");
}

std::vector<double> effect_column(const Config& config, const std::string& name, const std::string& parameter) {
  parameter_of(name, parameter);
  const auto* values = given(config, name, parameter);
  return values ? *values : std::vector<double>{};
}

std::vector<int> effect_list(const Config& config, const std::string& name, const std::string& parameter) {
  std::vector<int> list;
  for (const double v : effect_column(config, name, parameter)) list.push_back(static_cast<int>(v));
  return list;
}

std::vector<double> typical_list(const EffectParameter& p) {
  if (p.whole) return {1, 2};
  if (!p.strength) return {0, 0.25, 1};
  return {p.typical, 0.8 * p.typical, 0.6 * p.typical};
}

}  // namespace tumble
