#include "analysis/stills.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "analysis/charge_motion.h"
#include "core/error.h"

namespace tumble::analysis {
namespace {

namespace fs = std::filesystem;

bool is_picture(const fs::path& file) {
  std::string kind = file.extension().string();
  std::transform(kind.begin(), kind.end(), kind.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return kind == ".png" || kind == ".jpg" || kind == ".jpeg";
}

}  // namespace

bool are_stills(const std::string& path) {
  std::error_code ec;
  return fs::is_directory(path, ec) || is_picture(path);
}

std::vector<std::string> still_files(const std::string& path) {
  std::error_code ec;
  if (is_picture(path) && fs::is_regular_file(path, ec)) return {path};
  if (!fs::is_directory(path, ec))
    throw InputError(path, "is no folder; a folder of stills (PNG or JPEG) was expected");
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(path, ec))
    if (is_picture(entry.path())) files.push_back(entry.path().string());
  if (files.empty()) throw InputError(path, "holds no stills; PNG or JPEG pictures were expected");
  std::sort(files.begin(), files.end());
  return files;
}

cv::Mat read_still(const std::string& file) {
  cv::Mat still = cv::imread(file, cv::IMREAD_COLOR);
  if (still.empty()) throw InputError(file, "cannot be read as a picture; PNG or JPEG was expected");
  return still;
}

}  // namespace tumble::analysis
