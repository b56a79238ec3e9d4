#pragma once
#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "core/config.h"
#include "core/mill_camera.h"

// What a pinhole camera makes of a mill.
namespace tumble::analysis {

// Pixel at which a place of the mill frame is seen; NaN for what lies behind the camera.
cv::Point2d picture_of(const MillCamera& camera, const Eigen::Vector3d& place);

// Where the line of sight of a pixel meets the plane `z` of the mill frame; NaN where it does not.
Eigen::Vector2d mill_place_at(const MillCamera& camera, const cv::Point2d& pixel, double z);

// Half the mean width at which a ball is seen [px].
double apparent_radius(const MillCamera& camera, const Eigen::Vector3d& place, double radius);

// Angle between the line of sight to the mill's origin and its axis [rad].
double obliqueness(const MillCamera& camera);

// The same camera for a mill frame turned counter-clockwise by `roll` [rad], as seen: what lay at angle `roll` in the
// old frame lies at 0 in the new one.
MillCamera rolled(const MillCamera& camera, double roll);

// The same camera with lengths times `factor`, or for pictures enlarged `factor` times along each side.
MillCamera with_lengths_times(const MillCamera& camera, double factor);
// The same view of the glass from so far away that depth does not show.
MillCamera from_afar(const MillCamera& camera);
MillCamera for_enlarged_pictures(const MillCamera& camera, double factor);

}  // namespace tumble::analysis
