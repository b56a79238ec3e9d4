#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/frame.h"
#include "core/image.h"
#include "core/pixel_tracks.h"
#include "core/progress.h"

// Front door of analysis: frames (truth) or pictures (films, stills) -> ChargeMotion.
namespace tumble::analysis {

// Fills `frame` with the next one; false at the end.
using NextFrame = std::function<bool(Frame&)>;

// Truth from a run's frames.
ChargeMotion measure_frames(const RunSetup& setup, const NextFrame& next, const Progress& progress = {});

// Of that, toe and shoulder frame by frame, the same numbers for a tenth of the work; heads are not looked for.
std::vector<ProfileRow> measure_edges(const RunSetup& setup, const NextFrame& next, const Progress& progress = {});

// The whole truth of a simulation that hands its frames out one by one and keeps none; or all that balls tell which
// another program has followed in metres: the same code.
class FrameMeasurer {
 public:
  explicit FrameMeasurer(const RunSetup& setup);
  ~FrameMeasurer();
  void add(const Frame& frame);
  // Balls seen at one moment, by id; not all need to be there. Mill angle in radians, NaN where nothing tells it.
  void add(double time, double mill_angle, std::span<const TrackPoint> balls);
  ChargeMotion finish();  // once

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Of that truth, the means of torque, its closure, toe and shoulder (without errors): the same numbers for a tenth of
// the work.
class MeansMeasurer {
 public:
  explicit MeansMeasurer(const RunSetup& setup);
  ~MeansMeasurer();
  void add(const Frame& frame);
  ChargeMotion finish() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct FilmOptions {
  const Config* mill = nullptr;            // what is known of the mill (may be partial), or nothing
  double recorded_fps = kNotGiven;         // the camera's rate where known and different from the file's [1/s]
  Rotation rotation = Rotation::kUnknown;  // unknown: found from the film
  // Where wanted: the film with all that was found drawn over it, picture by picture, and its contact sheet.
  std::function<void(const Image&)> overlay, sheet;
};

// A film in any container that OpenCV reads. Throws InputError when it cannot be read or no mill is found in it.
ChargeMotion measure_film(const std::string& path, const FilmOptions& options, const Progress& progress = {});

struct TracksOptions : FilmOptions {
  double centre_u_px = kNotGiven, centre_v_px = kNotGiven;  // of the mill's axis; not given: by the balls it carries
  double metres_per_pixel = kNotGiven;                      // not given: by the mill's diameter, else the balls' radii
};

// Balls that another program has followed through a film, in its pixels. The clock is told from flights.
ChargeMotion measure_tracks(const PixelTracks& tracks, const TracksOptions& options);

// Whether a path is of stills (a folder, or one PNG or JPEG) and not of a film.
bool are_stills(const std::string& path);

// A folder of still pictures of one mill, far apart in time or not, in order of their names; or one still.
ChargeMotion measure_stills(const std::string& path, const FilmOptions& options, const Progress& progress = {});

}  // namespace tumble::analysis
