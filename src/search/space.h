// The design space of a study: its variables and the unit cube that searchers see.
#pragma once

#include <optional>
#include <vector>

#include "base/random.h"
#include "base/rooms.h"
#include "config/describe.h"
#include "design/study.h"
#include "optim/problem.h"

namespace papilla::search {

// Shallower relief is none: polished glass is as rough, and no process holds such a depth [m].
// Else a search finds textures of a nanometre whose patch has the luckier skins.
inline constexpr double kLeastDepth = 2e-9;

class DesignSpace {
 public:
  explicit DesignSpace(const Study& study);
  DesignSpace(const DesignSpace&) = delete;
  DesignSpace& operator=(const DesignSpace&) = delete;

  const Space& cube() const { return cube_; }
  std::size_t size() const { return cube_.size(); }
  std::vector<double> value(const Point& unit) const;
  Point unit(const std::vector<double>& value) const { return cube_.unit(value); }
  Point snapped(const Point& unit) const { return cube_.snapped(unit); }

  Design design(const Point& unit) const { return design_of(value(unit)); }
  Design design_of(const std::vector<double>& values) const;  // SI, exactly these
  // The study's own design, or the nearest to it where its file has values outside the space.
  Point unit_of_study() const;
  // What the study's file says of the variables, SI, inside the space or not. Of a number that its
  // space fixes that value; the middle of the range where its own design has no such number.
  const std::vector<double>& own_values() const { return own_value_; }
  bool own_is_beside(std::size_t variable) const { return own_beside_[variable]; }  // the space
  // The same texture with the study's own finish and drive. A number of these that lies outside the
  // space has the coordinate kBeside, of which value() and design() are the study's own.
  static constexpr double kBeside = -1;
  Point with_own_finish(Point unit) const;
  static bool is_beside(const Point& unit);  // some number of it lies outside the space
  std::vector<Point> starts() const;
  // All corners of the first eight variables, where small features and borders of limits lie, and a
  // thousand places drawn inside.
  std::vector<Point> corners_and_places(RandomStream& random) const;
  // The same surface without its texture, where the space holds that and the point has a texture.
  std::optional<Point> flattened(const Point& unit) const;
  // The variable is one of this design's numbers: by its own key, or by another kind's word for one
  // that no other variable names. Of a number without effect at depth 0 too.
  bool acts(const Design& design, std::size_t variable) const;

  // What the response depends on more directly than on the variables: the open share of a lattice,
  // as a length over the period, where both lengths vary. For SearchProblem::features.
  bool has_features() const;
  std::vector<double> features(const Point& unit) const;

 private:
  // The representative of all points that are the same design: numbers without effect on this kind
  // of texture, or at depth 0, take the study's own value.
  Point collapsed(const Point& unit) const;
  // Flat by one variable alone; nothing where that is not possible, or is so already.
  std::optional<Point> flat_by(std::size_t variable, const Point& unit) const;
  // The variable has an effect on a design with these numbers: it names one of them, or another
  // kind's word for one that no other variable names.
  bool acts(const std::vector<NumberField>& known, std::size_t variable) const;
  std::vector<double> values_of_study() const;  // as its file has them

  const Study& study_;
  Space cube_;
  std::vector<double> own_value_;      // of the study's own design
  std::vector<bool> own_beside_;       // which of them lie outside the space
  std::vector<std::string> sections_;  // of the variables
};

}  // namespace papilla::search
