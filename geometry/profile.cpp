#include "geometry/profile.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::geometry {

WallProfile::WallProfile(double depth, double wall_angle, double rim_radius)
    : depth_(depth), slope_(std::tan(std::min(wall_angle, kPi / 2 - 1e-9))), rim_(rim_radius) {
  // The arc is tangent to the land and to the wall, which turn by the wall angle.
  start_ = -rim_ * std::tan(0.5 * wall_angle);
  rim_end_ = rim_ * std::sin(wall_angle);
  rim_drop_ = rim_ * (1 - std::cos(wall_angle));
  if (rim_drop_ >= depth_ && rim_ > 0) {  // shallower than the rim: the floor cuts the arc
    rim_drop_ = depth_;
    rim_end_ = std::sqrt(depth_ * (2 * rim_ - depth_));
    floor_ = rim_end_;
  } else {
    floor_ = rim_end_ + (depth_ - rim_drop_) / slope_;
  }
}

double WallProfile::integral(double s) const {
  const double t = s - start_;
  if (t <= 0) return 0;
  const auto arc = [this](double x) {
    return rim_ > 0 ? rim_ * x - 0.5 * (x * std::sqrt(std::max(0.0, rim_ * rim_ - x * x)) +
                                        rim_ * rim_ * std::asin(std::min(1.0, x / rim_)))
                    : 0;
  };
  double sum = arc(std::min(t, rim_end_));
  if (t > rim_end_) {
    const double x = std::min(t, floor_) - rim_end_;
    sum += x * (rim_drop_ + 0.5 * slope_ * x);
  }
  if (t > floor_) sum += (t - floor_) * depth_;
  return sum;
}

double WallProfile::drop(double s) const {
  const double t = s - start_;
  if (t <= 0) return 0;
  if (t >= floor_) return depth_;
  if (t > rim_end_) return rim_drop_ + slope_ * (t - rim_end_);
  return rim_ - std::sqrt(rim_ * rim_ - t * t);
}

double WallProfile::inside(double drop) const {
  if (drop <= rim_drop_) return start_ + std::sqrt(drop * (2 * rim_ - drop));
  return start_ + rim_end_ + (drop - rim_drop_) / slope_;
}

double WallProfile::mean_drop(double s, double pixel) const {
  if (depth_ <= 0) return 0;
  return (integral(s + 0.5 * pixel) - integral(s - 0.5 * pixel)) / pixel;
}

}  // namespace papilla::geometry
