#include "render/film_dress.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "render/paint.h"

namespace tumble::render {

std::vector<BallDress> dress(const BallLook& look, std::span<const int> ball_class, std::uint64_t seed) {
  std::vector<BallDress> all(ball_class.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    Random random(seed * 0x9E3779B9ull + 7919 * i + 1);
    random.next();
    BallDress& b = all[i];
    const std::size_t kinds = std::min<std::size_t>(look.materials.size(), 4);
    const std::size_t kind =
        look.by_class ? static_cast<std::size_t>(ball_class[i]) % kinds : static_cast<std::size_t>(random.below(kinds));
    const BallMaterial& material = look.materials[kind];
    b.material = static_cast<float>(kind);
    b.colour = material.colour;
    b.brightness = static_cast<float>(std::exp(material.variation * std::clamp(gaussian(random), -2.5, 2.5)));
    b.chance_x = static_cast<float>(random.uniform());
    b.chance_y = static_cast<float>(random.uniform());
    if (chance(random, look.painted_share) && !look.paints.empty())
      b.colour = look.paints[random.below(look.paints.size())];
    if (look.mark != BallMark::kNone && chance(random, look.marked_share)) {
      b.kind = look.mark == BallMark::kLine ? 1.f : look.mark == BallMark::kHalf ? 2.f : 3.f;
      b.marked = true;
    } else if (chance(random, look.hollow_share)) {
      b.kind = 4;
    }
    b.tilt = static_cast<float>(look.mark_tilt * gaussian(random));
    if (b.kind == 4) b.tilt = static_cast<float>(random.uniform(0, 6));
  }
  Random random(seed * 59 + 31);
  for (const Light& colour : look.tracers) {
    if (all.empty()) break;
    BallDress& b = all[random.below(all.size())];
    b.colour = colour;
    b.kind = 0;
    b.marked = false;
    b.tracer = true;
    b.brightness = 1;
  }
  return all;
}

}  // namespace tumble::render
