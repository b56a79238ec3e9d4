#include "io/xdmf_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/hdf5.h"
#include "io/output.h"
#include "io/run_layout.h"

namespace tumble::io {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

// One frame of an array [frames][balls] or [frames][balls][2], as a slab.
std::string slab(const std::string& file, const char* path, std::size_t frame, const RunSetup& setup, bool pairs) {
  const std::size_t n = setup.balls.size();
  const std::string tail = pairs ? " 2" : "", zeros = pairs ? " 0 0" : " 0", ones = pairs ? " 1 1" : " 1";
  return fmt::format(
      R"(<DataItem ItemType="HyperSlab" Dimensions="{0}{1}"><DataItem Dimensions="3 {2}" Format="XML">{3}{4} 1{5} 1 {0}{1}</DataItem>)"
      R"(<DataItem Dimensions="{6} {0}{1}" NumberType="Float" Precision="4" Format="HDF">{7}:/{8}/value</DataItem></DataItem>)",
      n, tail, pairs ? 3 : 2, frame, zeros, ones, setup.frame_count, file, path);
}

}  // namespace

void write_xdmf(const std::filesystem::path& run_file, const RunSetup& setup) {
  const std::string file = escaped(run_file.filename().string());
  const std::size_t n = setup.balls.size();
  std::vector<double> time;
  {
    const auto held = hdf5::lock();
    time = hdf5::read_array<double>(hdf5::open_file(run_file, hdf5::Access::kRead), run_layout::kTime);
  }
  std::string text = R"(<?xml version="1.0"?>
<Xdmf Version="2.0"><Domain><Grid Name="balls" GridType="Collection" CollectionType="Temporal">
)";
  for (std::size_t k = 0; k < time.size(); ++k) {
    const auto scalar = [&](const char* name, const char* path) {
      return fmt::format(R"(<Attribute Name="{}" AttributeType="Scalar" Center="Node">{}</Attribute>)", name,
                         slab(file, path, k, setup, false));
    };
    text += fmt::format(
        R"(<Grid Name="frame"><Time Value="{0}"/><Topology TopologyType="Polyvertex" NumberOfElements="{1}"/>)"
        R"(<Geometry GeometryType="XY">{2}</Geometry>)",
        time[k], n, slab(file, "particles/balls/position", k, setup, true));
    text += fmt::format(
        R"(<Attribute Name="radius" AttributeType="Scalar" Center="Node"><DataItem Dimensions="{0}" NumberType="Float" Precision="8" Format="HDF">{1}:/particles/balls/radius</DataItem></Attribute>)",
        n, file);
    text += fmt::format(R"(<Attribute Name="velocity" AttributeType="Matrix" Center="Node">{}</Attribute>)",
                        slab(file, "particles/balls/velocity", k, setup, true));
    text += scalar("angle", "particles/balls/angle") + scalar("angular_velocity", "particles/balls/angular_velocity");
    text += "</Grid>\n";
  }
  text += "</Grid></Domain></Xdmf>\n";
  std::filesystem::path path = run_file;
  path.replace_extension(".xdmf");
  write_text(path, text);
}

}  // namespace tumble::io
