#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

// Everything that makes a filmed picture of a mill: camera, light, materials, dirt, what stands around and in between.
// Lengths in the mill are in shell radii R unless they say otherwise, so that a look fits any mill; colours are linear
// light, 1 = a white sheet in full light.
namespace tumble::render {

using Light = Eigen::Vector3f;  // red, green, blue; linear

struct FilmLens {
  int width = 1280, height = 720;     // [px], even
  double focal = 1800;                // [px]
  Eigen::Vector3d position{0, 0, 6};  // of the camera in the mill's frame [R]
  double yaw = 0, pitch = 0;          // of the optical axis against -z: > 0 looks to +x, to +y [rad]
  double roll = 0;                    // > 0: the picture is turned counter-clockwise [rad]
  double centre_u = 639.5;            // principal point [px]
  double centre_v = 359.5;
  double k1 = 0, k2 = 0;  // radial distortion, as OpenCV has it
};

struct FilmTiming {
  double exposure = 0.002;  // [s]
  double readout = 0;       // first row to last (rolling shutter) [s]; 0: all rows at once
  double flicker = 0;       // amplitude of the lamps' flicker, share of the light
  double flicker_hz = 100;
  double flicker_phase = 0;  // [rad]
};

struct FilmSensor {
  double level = 0.7;             // where the mill's bright parts lie; above 1 they are blown out
  double blur = 0.5;              // sigma of lens and defocus [px]
  double shot = 0.004;            // shot noise: variance per signal
  double read = 0.004;            // read noise: sigma
  double grain = 0;               // share of the noise that neighbouring pixels have in common, [0, 1]
  double sharpening = 0;          // unsharp mask's share
  double vignette = 0;            // loss of light in the corners, share
  double tilt_x = 0, tilt_y = 0;  // brightness from edge to edge, share
  double gamma = 2.2;
  double contrast = 0;    // S-curve, [-1, 1]
  double saturation = 1;  // 0 = grey camera
  Light white{1, 1, 1};   // white balance
  double haze = 0;        // light that is everywhere (veiling glare)
};

struct Lamp {
  Eigen::Vector3d towards{0.3, 0.5, 0.8};  // unit
  Light colour{1, 1, 1};
  double size = 0.15;  // angular radius [rad]: soft shadows, wide highlights
};

struct Surface {
  Light colour{0.4f, 0.4f, 0.4f};
  double gloss = 0.3;      // strength of the highlights
  double roughness = 0.4;  // (0, 1]
  double brushed = 0.3;    // concentric scratches
  double blotches = 0.2;   // uneven brightness
  double grain = 0.1;      // fine texture
  double rust = 0.0;       // share of the face
  Light rust_colour{0.25f, 0.11f, 0.05f};
};

struct BallMaterial {
  Light colour{0.5f, 0.5f, 0.5f};
  double metal = 0.8;       // 0 = paint or ceramic, 1 = bare metal that mirrors its surroundings
  double specular = 0.5;    // strength of the lamps' highlights
  double roughness = 0.25;  // (0, 1]
  double translucent = 0;   // glass: light gathers opposite the lamp
  double variation = 0.1;   // spread of brightness from ball to ball
  double dirt = 0.2;        // uneven surface
  double rust = 0;          // share of the face
};

enum class BallMark { kNone, kLine, kHalf, kDots };

struct BallLook {
  std::vector<BallMaterial> materials{1};  // one to four
  bool by_class = false;                   // a material for each class of balls, or any for any ball
  BallMark mark = BallMark::kNone;
  double marked_share = 0;  // of the balls
  Light mark_colour{0.9f, 0.9f, 0.9f};
  double mark_width = 0.14;   // of a line, half, over the ball's radius
  double mark_tilt = 0;       // spread of the mark's plane against the axis [rad]
  std::vector<Light> paints;  // colours of painted balls
  double painted_share = 0;
  std::vector<Light> tracers;  // colours of single balls
  double hollow_share = 0;
  double hole = 0.35;       // radius of the hole over the ball's
  double occlusion = 0.6;   // darkening where balls meet
  double depth_fade = 0.5;  // darkening from glass to back plate, share
};

struct FlangeLook {
  bool there = true;
  double inner = 1.0, outer = 1.15;  // [R]
  double thick = 0.02;               // in front of the glass's inside [R]
  Surface surface;
  int bolts = 16;
  double bolt_size = 0.02;  // radius [R]
  bool hexagons = false;
  Light bolt_colour{0.5f, 0.5f, 0.5f};
  bool phase_mark = true;
  Light mark_colour{0.9f, 0.9f, 0.9f};
  int letters = 0;
};

struct PlateLook {
  Surface surface;
  double hub = 0.15;  // radius of the disc in the middle [R]; 0: none
  int bolts = 6;      // on the hub's circle
  int letters = 0;
  int decoys = 0;      // rings and discs as large as balls, that turn with the plate
  bool lines = false;  // a painted cross or radius
};

struct GlassLook {
  int glares = 0;    // soft blobs and streaks that stand still
  double glare = 0;  // their strength
  int windows = 0;   // mirrored bright rectangles
  double window = 0;
  int scratches = 0;  // turn with the glass
  double scratch = 0;
  double smudges = 0;  // dust and finger marks that turn
};

struct RoomLook {
  Light wall{0.25f, 0.25f, 0.25f};
  Light floor{0.1f, 0.08f, 0.06f};
  double floor_at = 0.9;                                 // share of the height
  double uneven = 0.2;                                   // light on the wall
  int rectangles = 0, cables = 0, discs = 0, heaps = 0;  // heaps: spare balls on the floor
  bool stand = true, wheels = false, display = false;
  Light stand_colour{0.03f, 0.06f, 0.12f};
  double defocus = 3;  // [px]
};

struct Bar {
  double angle = 0;            // of its direction [rad]
  double offset = 0;           // of its middle line from the mill's centre [R]
  double width = 0.1;          // [R]
  double begin = -9, end = 9;  // along it [R]
  Light colour{0.1f, 0.1f, 0.1f};
};

struct OccluderLook {
  std::vector<Bar> bars;
  double hub = 0;  // radius of a bearing in front of the mill's middle [R]; 0: none
  Light hub_colour{0.3f, 0.3f, 0.3f};
};

struct OverlayLook {
  int words = 0;
  bool clock = false;
};

struct FilmLook {
  std::uint64_t seed = 1;  // of everything that the numbers leave open: places of rust, of bolts, of clutter
  FilmLens lens;
  FilmTiming timing;
  FilmSensor sensor;
  std::vector<Lamp> lamps{1};  // one or two
  Light ambient_above{0.35f, 0.35f, 0.35f}, ambient_below{0.15f, 0.15f, 0.15f};
  BallLook balls;
  Surface liner;  // shell and lifters
  FlangeLook flange;
  PlateLook plate;
  GlassLook glass;
  RoomLook room;
  OccluderLook front;
  OverlayLook overlay;
};

// A look drawn at random. `level`: 0 a clean picture, 1 a careful laboratory, 2 a hurried one, 3 nasty.
FilmLook random_look(std::uint64_t seed, int level);

// A pleasant one: steel balls in a clean mill that fills the picture.
FilmLook studio_look(std::uint64_t seed, int width, int height);

// Aims and scales the view from where the camera stands: the middle of the mill's glass appears at (u, v), its radius
// as about `radius_px`. `crop`: the share of the way there that comes from cutting the picture out of a larger one,
// which moves the principal point, and not from turning the camera.
void place_mill(FilmLens& lens, int width, int height, double radius_px, double u, double v, double crop);

}  // namespace tumble::render
