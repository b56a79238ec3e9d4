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

// The whole of an array, told once; frames refer to it by its number and cut their slab out of it.
std::string whole(const std::string& file, const std::string& path, const std::string& shape, int precision) {
  return fmt::format(R"(<DataItem Dimensions="{}" NumberType="Float" Precision="{}" Format="HDF">{}:/{}</DataItem>)",
                     shape, precision, file, path);
}
std::string reference(std::size_t number) {
  return fmt::format(R"(<DataItem Reference="XML">/Xdmf/Domain/DataItem[{}]</DataItem>)", number);
}
constexpr char kNumber = '#';  // stands for the frame's
std::string slab(std::size_t array, std::size_t balls, bool pairs) {
  const std::string shape = std::to_string(balls) + (pairs ? " 2" : "");
  return fmt::format(
      R"(<DataItem ItemType="HyperSlab" Dimensions="{0}"><DataItem Dimensions="3 {1}" Format="XML">{2}{3} {0}</DataItem>{4}</DataItem>)",
      shape, pairs ? 3 : 2, kNumber, pairs ? " 0 0 1 1 1 1" : " 0 1 1 1", reference(array));
}
std::string attribute(const char* name, const char* type, const std::string& item) {
  return fmt::format(R"(<Attribute Name="{}" AttributeType="{}" Center="Node">{}</Attribute>)", name, type, item);
}

}  // namespace

void write_xdmf(const std::filesystem::path& run_file, std::int64_t frame_count, std::size_t balls) {
  const std::string file = escaped(run_file.filename().string());
  std::vector<double> time;
  {
    const auto held = hdf5::lock();
    time = hdf5::read_array<double>(hdf5::open_file(run_file, hdf5::Access::kRead), run_layout::kTime);
  }
  const auto arrays = run_layout::all_ball_arrays();  // position, velocity, angle, angular velocity
  std::string text = "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain>\n";
  for (const auto& array : arrays)
    text += whole(file, std::string(array.path) + "/value",
                  fmt::format("{} {}{}", frame_count, balls, array.second ? " 2" : ""), 4);
  text += "\n<Grid Name=\"balls\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  // Grids differ in time and number alone: what stands between those is made once, for runs of many frames.
  const std::string grid = fmt::format(R"("/><Topology TopologyType="Polyvertex" NumberOfElements="{}"/>)"
                                       R"(<Geometry GeometryType="XY">{}</Geometry>)",
                                       balls, slab(1, balls, true)) +
                           attribute("velocity", "Matrix", slab(2, balls, true)) +
                           attribute("angle", "Scalar", slab(3, balls, false)) +
                           attribute("angular_velocity", "Scalar", slab(4, balls, false));
  const std::string end =
      attribute("radius", "Scalar", whole(file, "particles/balls/radius", std::to_string(balls), 8)) + "</Grid>\n";
  for (std::size_t k = 0; k < time.size(); ++k) {
    const std::string number = std::to_string(k);
    text += R"(<Grid Name="frame"><Time Value=")" + fmt::format("{}", time[k]);
    std::size_t from = 0;
    for (std::size_t gap; (gap = grid.find(kNumber, from)) != std::string::npos; from = gap + 1) {
      text.append(grid, from, gap - from);
      text += number;
    }
    text.append(grid, from);
    text += end;
  }
  text += "</Grid></Domain></Xdmf>\n";
  std::filesystem::path path = run_file;
  path.replace_extension(".xdmf");
  write_text(path, text);
}

}  // namespace tumble::io
