#include "render/film_develop.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/quantile.h"
#include "core/units.h"
#include "render/film_sheets.h"

namespace tumble::render {
namespace {

// A separable Gaussian over all four channels; borders repeat.
void blur(Sheet& sheet, double sigma) {
  if (sigma < 0.15) return;
  const int reach = static_cast<int>(std::ceil(2.6 * sigma));
  std::vector<float> weight(static_cast<std::size_t>(reach) + 1);
  double sum = 0;
  for (int k = 0; k <= reach; ++k) {
    weight[k] = static_cast<float>(std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += (k ? 2 : 1) * weight[k];
  }
  for (float& w : weight) w /= static_cast<float>(sum);
  const int w = sheet.width, h = sheet.height, row = 4 * w, pad = 4 * reach;
  std::vector<float> wide(static_cast<std::size_t>(row + 2 * pad)), out(static_cast<std::size_t>(row));
  for (int j = 0; j < h; ++j) {
    float* line = sheet.at(0, j);
    std::copy(line, line + row, wide.begin() + pad);
    for (int i = 0; i < pad; ++i) {
      wide[i] = line[i % 4];
      wide[pad + row + i] = line[row - 4 + i % 4];
    }
    for (int i = 0; i < row; ++i) out[i] = weight[0] * wide[pad + i];
    for (int k = 1; k <= reach; ++k)
      for (int i = 0; i < row; ++i) out[i] += weight[k] * (wide[pad + i - 4 * k] + wide[pad + i + 4 * k]);
    std::copy(out.begin(), out.end(), line);
  }
  const std::vector<float> source = sheet.rgba;
  for (int j = 0; j < h; ++j) {
    float* line = sheet.at(0, j);
    const auto at = [&](int k) { return source.data() + static_cast<std::size_t>(std::clamp(k, 0, h - 1)) * row; };
    const float* middle = at(j);
    for (int i = 0; i < row; ++i) line[i] = weight[0] * middle[i];
    for (int k = 1; k <= reach; ++k) {
      const float *a = at(j - k), *b = at(j + k);
      for (int i = 0; i < row; ++i) line[i] += weight[k] * (a[i] + b[i]);
    }
  }
}

void put_in_front(Sheet& light, const StillSheets& still) {
  const Sheet& glare = still.glare;
  for (int j = 0; j < light.height; ++j) {
    // Bilinear between the glare's pixels, whose centres lie in the middles of four by four.
    const double y = std::clamp((j + 0.5) / 4 - 0.5, 0.0, glare.height - 1.001);
    const int gj = static_cast<int>(y);
    const auto b = static_cast<float>(y - gj);
    for (int i = 0; i < light.width; ++i) {
      const double x = std::clamp((i + 0.5) / 4 - 0.5, 0.0, glare.width - 1.001);
      const int gi = static_cast<int>(x);
      const auto a = static_cast<float>(x - gi);
      const float *p = glare.at(gi, gj), *q = glare.at(gi, gj + 1), *over = still.front.at(i, j);
      float* to = light.at(i, j);
      for (int c = 0; c < 3; ++c) {
        const float shine = (1 - b) * ((1 - a) * p[c] + a * p[c + 4]) + b * ((1 - a) * q[c] + a * q[c + 4]);
        to[c] = (to[c] + shine) * (1 - over[3]) + over[c];
      }
    }
  }
}

// Light that falls on a row for the time of its exposure, while the lamps flicker.
double flicker_of(const FilmTiming& timing, double row_time) {
  if (timing.flicker <= 0) return 1;
  const double w = 2 * kPi * timing.flicker_hz, half = 0.5 * w * timing.exposure;
  const double mean = half > 1e-6 ? std::sin(half) / half : 1.0;
  return 1 + timing.flicker * mean * std::sin(w * row_time + timing.flicker_phase);
}

void expose(Sheet& light, const FilmLook& look, float gain, double time) {
  const FilmSensor& sensor = look.sensor;
  const auto haze = static_cast<float>(sensor.haze);
  for (int j = 0; j < light.height; ++j) {
    const double y = (j + 0.5) / light.height - 0.5;
    const double row = flicker_of(look.timing, time + look.timing.readout * y) * (1 + sensor.tilt_y * y);
    for (int i = 0; i < light.width; ++i) {
      const double x = (i + 0.5) / light.width - 0.5;
      const double corner = 2 * (x * x + y * y);
      const auto by = static_cast<float>(row * (1 + sensor.tilt_x * x) * (1 - sensor.vignette * corner));
      float* p = light.at(i, j);
      for (int c = 0; c < 3; ++c) p[c] = (p[c] * gain + haze) * by * sensor.white[c];
    }
  }
}

// Nearly Gaussian, of variance 1: four uniform numbers out of one draw.
float noise_of(Random& random) {
  const std::uint64_t z = random.next();
  const auto sum = static_cast<float>((z & 0xFFFF) + (z >> 16 & 0xFFFF) + (z >> 32 & 0xFFFF) + (z >> 48));
  return (sum / 65535.0f - 2.0f) * 1.7320508f;
}

void add_noise(Sheet& light, const FilmSensor& sensor, std::uint64_t seed) {
  if (sensor.shot <= 0 && sensor.read <= 0) return;
  Random random(seed);
  Sheet noise(light.width, light.height);
  for (std::size_t i = 0; i < noise.rgba.size(); i += 4)
    for (std::size_t c = 0; c < 3; ++c) noise.rgba[i + c] = noise_of(random);
  if (sensor.grain > 0) {
    Sheet coarse = noise;
    blur(coarse, 0.8);
    const auto g = static_cast<float>(sensor.grain);
    // A blur of this sigma leaves the noise about 0.38 of its size.
    const float whole = 1 / std::sqrt((1 - g) * (1 - g) + 0.38f * g * (0.38f * g + 0.5f * (1 - g)));
    for (std::size_t i = 0; i < noise.rgba.size(); ++i)
      noise.rgba[i] = whole * ((1 - g) * noise.rgba[i] + g * coarse.rgba[i]);
  }
  const auto shot = static_cast<float>(sensor.shot), read2 = static_cast<float>(sensor.read * sensor.read);
  for (std::size_t i = 0; i < noise.rgba.size(); ++i)
    light.rgba[i] += noise.rgba[i] * std::sqrt(shot * std::max(light.rgba[i], 0.0f) + read2);
}

// Linear light to 0..255 over its square root, where dark tones have room.
class Tones {
 public:
  explicit Tones(const FilmSensor& sensor) {
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double root = static_cast<double>(i) / kSteps;
      const double y = std::min(1.0, std::pow(root * root, 1 / sensor.gamma));
      const double curved = y * y * (3 - 2 * y);
      table_[i] = static_cast<float>(255 * (y + sensor.contrast * (curved - y)));
    }
  }
  float of(float light) const {
    const float x = std::sqrt(std::clamp(light, 0.0f, 1.0f)) * kSteps;
    const auto i = static_cast<std::size_t>(x);
    return table_[i] + (x - static_cast<float>(i)) * (table_[i + 1] - table_[i]);
  }

 private:
  static constexpr int kSteps = 2048;
  std::array<float, kSteps + 2> table_{};
};

void encode(Sheet& light, const FilmSensor& sensor) {
  const Tones tones(sensor);
  const auto saturation = static_cast<float>(sensor.saturation);
  for (std::size_t i = 0; i < light.rgba.size(); i += 4) {
    float* p = light.rgba.data() + i;
    const float grey = 0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2];
    for (int c = 0; c < 3; ++c) p[c] = tones.of(grey + saturation * (p[c] - grey));
  }
  if (sensor.sharpening <= 0) return;
  Sheet soft = light;
  blur(soft, 1.0);
  const auto by = static_cast<float>(sensor.sharpening);
  for (std::size_t i = 0; i < light.rgba.size(); ++i) light.rgba[i] += by * (light.rgba[i] - soft.rgba[i]);
}

}  // namespace

float exposure_gain(const Sheet& light, const FilmLook& look, const Spot& centre, double radius) {
  std::vector<float> inside;
  for (int j = 0; j < light.height; j += 3)
    for (int i = 0; i < light.width; i += 3)
      if ((Spot(i, j) - centre).norm() < radius) {
        const float* p = light.at(i, j);
        inside.push_back(0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2]);
      }
  if (inside.empty()) return 1;
  return static_cast<float>(look.sensor.level) / std::max(quantile_of(std::move(inside), 0.95), 1e-4f);
}

double glare_at(const StillSheets& still, double u, double v) {
  const Sheet& glare = still.glare;
  const int i = static_cast<int>(std::clamp((u + 0.5) / 4, 0.0, glare.width - 1.0));
  const int j = static_cast<int>(std::clamp((v + 0.5) / 4, 0.0, glare.height - 1.0));
  const float* p = glare.at(i, j);
  return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
}

Image develop(Sheet light, const FilmLook& look, const StillSheets& still, float gain, double time,
              std::uint64_t noise_seed) {
  put_in_front(light, still);
  expose(light, look, gain, time);
  blur(light, look.sensor.blur);
  add_noise(light, look.sensor, noise_seed);
  encode(light, look.sensor);
  Image image(light.width, light.height);
  for (std::size_t i = 0; i < light.rgba.size(); ++i)
    image.rgba[i] = static_cast<std::uint8_t>(std::clamp(light.rgba[i] + 0.5f, 0.0f, 255.0f));
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  if (look.overlay.clock || look.overlay.words > 0) {
    Sheet over(light.width, light.height);
    write_overlay(over, look, time);
    for (std::size_t i = 0; i < over.rgba.size(); i += 4) {
      const float a = over.rgba[i + 3];
      if (a <= 0) continue;
      for (std::size_t c = 0; c < 3; ++c)
        image.rgba[i + c] =
            static_cast<std::uint8_t>(std::clamp(image.rgba[i + c] * (1 - a) + 255 * over.rgba[i + c], 0.0f, 255.0f));
    }
  }
  return image;
}

}  // namespace tumble::render
