#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

// One page of vector graphics for print, as SVG or PDF: the door to cairo. Places are in millimetres from the upper
// left corner, y down. Letters are Liberation Sans (of Arial's measures): outlines in SVG, embedded in PDF, so that a
// page looks the same everywhere. The same calls give the same bytes.
namespace tumble::io {

struct PagePoint {
  double x = 0, y = 0;  // [mm]
};

struct Ink {  // sRGB, [0, 1]
  double red = 0, green = 0, blue = 0, alpha = 1;
};

struct Pen {
  Ink ink = {};
  double width = 0.2;               // [mm]
  std::vector<double> dashes = {};  // lengths on and off [mm]; empty: a whole line
};

struct Lettering {
  double size_pt = 8;
  bool bold = false;
  double along = 0;      // where the place is along the text: 0 its beginning, 0.5 its middle, 1 its end
  bool upwards = false;  // reads from below to above
  Ink ink = {};
};

class VectorPage {
 public:
  // Throws WorkError where the letters' font is not there.
  VectorPage(std::filesystem::path path, double width_mm, double height_mm, const std::string& title);
  ~VectorPage();
  VectorPage(const VectorPage&) = delete;
  VectorPage& operator=(const VectorPage&) = delete;

  void line(const std::vector<PagePoint>& points, const Pen& pen, bool closed = false);
  void area(const std::vector<PagePoint>& corners, const Ink& ink);
  void disc(PagePoint centre, double radius, const Ink& ink);
  void circle(PagePoint centre, double radius, const Pen& pen);
  void text(PagePoint baseline, const std::string& words, const Lettering& how);
  double text_width(const std::string& words, const Lettering& how) const;  // [mm]

  // What is drawn until unclip() shows inside this rectangle only.
  void clip(PagePoint upper_left, double width, double height);
  void unclip();

  // Writes the file, which appears whole or not at all. Throws WorkError. What was not saved is gone.
  void save();

  // Does the name end as one of the kinds that can be written: .svg, .pdf?
  static bool writes(const std::filesystem::path& path);

 private:
  struct Cairo;
  std::filesystem::path path_;
  std::unique_ptr<Cairo> cairo_;
};

}  // namespace tumble::io
