#pragma once
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace tumble::analysis {

// The stills of a folder in order of their names, or the one that `path` is. Throws InputError where there are none.
std::vector<std::string> still_files(const std::string& path);

// 8-bit BGR. Throws InputError where the file is no picture.
cv::Mat read_still(const std::string& file);

}  // namespace tumble::analysis
