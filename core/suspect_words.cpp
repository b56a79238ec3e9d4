#include "core/suspect_words.h"

#include <algorithm>
#include <array>

namespace tumble {
namespace {

struct Words {
  const char* name;
  const char* title;
  const char* more;  // of a strength > 0
  const char* less;  // < 0; nullptr where there is none
};
constexpr std::array kWords{
    Words{"rolling_resistance", "rolling resistance", "The balls roll less freely than the model has it", nullptr},
    Words{"friction_weakening", "friction that falls with sliding speed", "Friction falls where surfaces slide fast",
          nullptr},
    Words{"wall_friction", "other friction at the shell", "Shell and lifters grip the balls more than the model has it",
          "Shell and lifters grip the balls less than the model has it"},
    Words{"fluid_drag", "drag of a fluid", "A fluid slows the balls, and the model has none", nullptr},
    Words{"slurry_pool", "a slurry pool", "A pool lies in the mill that carries and slows the balls", nullptr},
    Words{"impact_restitution", "restitution that falls with impact speed",
          "Hard impacts lose more energy than the model has it", nullptr},
    Words{"end_wall_friction", "friction of the end walls", "The ends of the mill rub on the balls", nullptr},
    Words{"cohesion", "cohesion", "Balls that touch stick together", nullptr},
    Words{"lifter_wear", "worn lifters", "The lifters are worn", nullptr},
    Words{"hertz_contact", "Hertzian contact", "Contacts stiffen as they are pressed", nullptr},
    Words{"speed_ripple", "ripple of the mill’s speed", "The mill does not turn evenly within a revolution", nullptr},
    Words{"missing_lifters", "missing lifters", "The mill has lost lifters", nullptr},
    Words{"camera_scale", "wrong scale of the picture", "The picture shows lengths longer than they are",
          "The picture shows lengths shorter than they are"},
    Words{"camera_rotation", "turned camera", "The picture is turned counter-clockwise",
          "The picture is turned clockwise"},
    Words{"frame_clock", "wrong clock of the film", "The film’s clock gives times longer than they are",
          "The film’s clock gives times shorter than they are"},
    Words{"filling_error", "misjudged filling", "The mill holds more than was told",
          "The mill holds less than was told"},
    Words{"speed_error", "misjudged speed", "The mill turns faster than was told",
          "The mill turns slower than was told"},
    Words{"torque_offset", "wrong zero of the torque", "The torque reads too high", "The torque reads too low"},
    Words{"none", "nothing missing", "Nothing is missing from the model", nullptr},
    Words{"unknown", "something not on the list", "Something is missing that is not on the list", nullptr},
};

const Words* find(const std::string& name) {
  for (const Words& w : kWords)
    if (name == w.name) return &w;
  return nullptr;
}

}  // namespace

std::string words_of_suspect(const std::string& name) {
  if (const Words* words = find(name)) return words->title;
  std::string letters = name;
  std::replace(letters.begin(), letters.end(), '_', ' ');
  return letters;
}

std::string statement_of_suspect(const std::string& name, double strength) {
  const Words* words = find(name);
  if (words == nullptr) return "The model lacks " + words_of_suspect(name);
  return strength < 0 && words->less != nullptr ? words->less : words->more;
}

}  // namespace tumble
