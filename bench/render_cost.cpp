// What a frame of a film costs, step by step: as `tumble render --threads 1` does them, with a clock round each.
//   render_cost RUN.h5 [--size 1280x720] [--preset medium] [--overlay toe,shoulder | none] [--repeat 1]
// Prints CPU milliseconds a frame (drawing copies no picture; encoding includes the colours' conversion, which is given
// apart too) and how long the steps before the first frame take.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <vector>

#include "analysis/charge_motion.h"
#include "core/large_arrays.h"
#include "core/parallel_for.h"
#include "io/film_file.h"
#include "io/run_file.h"
#include "io/yuv420.h"
#include "render/renderer.h"

using namespace tumble;
namespace fs = std::filesystem;

namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Adds the CPU time of its scope.
class Timed {
 public:
  explicit Timed(double& sum) : sum_(sum), start_(cpu_seconds()) {}
  ~Timed() { sum_ += cpu_seconds() - start_; }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  double& sum_;
  double start_;
};

void measure(const fs::path& path, const render::Style& style, const io::FilmFormat& format, int repeat) {
  double start = cpu_seconds(), loading = start, opening = 0, truth = 0, reading = 0, drawing = 0, colours = 0,
         encoding = 0;
  keep_large_arrays();
  const io::RunReader run(path);
  if (style.overlay.toe) {
    const Timed timed(truth);
    std::size_t next = 0;
    analysis::measure_edges(run.setup(), [&](Frame& frame) {
      if (next >= run.frame_count()) return false;
      frame = run.frame(next++);
      return true;
    });
  }
  std::vector<std::uint8_t> y(std::size_t(style.width) * style.height), cb(y.size() / 4), cr(y.size() / 4);
  const io::Yuv420 planes{y.data(), cb.data(), cr.data(), style.width, style.width / 2, style.width / 2};
  std::unique_ptr<render::Renderer> renderer;
  std::unique_ptr<io::FilmWriter> film;
  const fs::path scratch = fs::temp_directory_path() / fmt::format("render_cost_{}.mp4", std::clock());
  {
    const Timed timed(opening);
    renderer = std::make_unique<render::Renderer>(run.setup(), style);
    film = std::make_unique<io::FilmWriter>(scratch.string(), format);
    renderer->draw(run.frame(0), {288, 18, run.time(), run.torque(), {}});
  }
  for (int k = 0; k < repeat; ++k) {
    for (std::size_t i = 0; i < run.frame_count(); ++i) {
      Frame frame;
      {
        const Timed timed(reading);
        frame = run.frame(i);
      }
      const Image* image = nullptr;
      {
        const Timed timed(drawing);
        image = &renderer->draw(frame, {288, 18, run.time(), run.torque(), {}});
      }
      {
        const Timed timed(colours);
        io::yuv420_from_rgba(*image, planes);
      }
      const Timed timed(encoding);
      film->write(*image);
    }
  }
  {
    const Timed timed(encoding);
    film->finish();
  }
  fs::remove(scratch);
  const double frames = repeat * double(run.frame_count());
  const auto each = [&](double seconds) { return 1000 * seconds / frames; };
  fmt::print(
      "frames {} reading_ms {:.3f} truth_ms {:.3f} drawing_ms {:.3f} colours_ms {:.3f} encoding_ms {:.3f} "
      "loading_ms_once "
      "{:.1f} opening_ms_once {:.1f} rest_over_encoding {:.3f}\n",
      frames, each(reading), each(truth), each(drawing), each(colours), each(encoding - colours), 1000 * loading,
      1000 * opening, (reading + truth + drawing + colours + loading + opening) / (encoding - colours));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("What a frame of a film costs, step by step");
  fs::path run;
  std::vector<int> size{1280, 720};
  render::Style style;
  io::FilmFormat format;
  std::string overlay = "toe,shoulder";
  int repeat = 1;
  app.add_option("run", run, "RUN.h5")->required();
  app.add_option("--size", size, "Picture size [px], such as 1920x1080")->delimiter('x')->expected(2);
  app.add_option("--preset", format.preset, "x264's");
  app.add_option("--overlay", overlay)->check(CLI::IsMember({"toe,shoulder", "none"}));
  app.add_option("--repeat", repeat, "How many times the run is filmed")->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  style.width = format.width = size[0];
  style.height = format.height = size[1];
  style.overlay.toe = style.overlay.shoulder = overlay != "none";
  format.threads = 1;
  limit_threads(1);
  try {
    measure(run, style, format, repeat);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
