#include "physics/optics/lattice/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/optics/lattice/lattice.h"
#include "physics/optics/screen.h"

namespace papilla::optics {
namespace {

Complex permittivity(double index, double extinction = 0) {
  const Complex n(index, extinction);
  return n * n;
}

// Width of the outline at a height: of the last terrace that reaches it from the surroundings.
double width_at(const FeatureArray& array, double height) {
  double around = 0, width = array.terraces.front().width;
  for (const Terrace& t : array.terraces) {
    width = t.width;
    if ((around - height) * (t.height - height) <= 0) return std::max(0.0, width);
    around = t.height;
  }
  return std::max(0.0, width);
}

constexpr double kStep = 40e-9;  // between planes of sloped walls [m]
// A slice of lines takes a millisecond or two, one of discs a tenth of a second and more.
double most_slices(const FeatureArray& array) {
  return array.shape == FeatureArray::Shape::Line ? 64 : 16;
}

// Planes between which the walls count as upright, from the lowest up.
std::vector<double> planes_of(const FeatureArray& array) {
  const double end = array.terraces.back().height;
  const double wanted = std::ceil(std::abs(end) / kStep - 1e-6);  // whatever a multiple rounds to
  const int slices = array.terraces.size() == 1
                         ? 1
                         : static_cast<int>(std::clamp(wanted, 4.0, most_slices(array)));
  std::vector<double> out;
  for (int k = 0; k <= slices; ++k) out.push_back(std::min(end, 0.0) + std::abs(end) * k / slices);
  return out;
}

LatticeSlice flat_slice(Complex epsilon, double thickness) {
  return {thickness, 0, 0, epsilon, epsilon};
}

// The same with x and y exchanged: the other plane of incidence.
LatticeStack turned(LatticeStack stack) {
  std::swap(stack.cell.lx, stack.cell.ly);
  for (LatticeSlice& s : stack.slices) std::swap(s.width_x, s.width_y);
  return stack;
}

// Of light that falls in from the fill.
LatticeStack reversed(LatticeStack stack) {
  std::reverse(stack.slices.begin(), stack.slices.end());
  std::swap(stack.from, stack.to);
  return stack;
}

class LatticeFace {
 public:
  LatticeFace(const FeatureArray& array, const OpticalMedia& media, const Meters& meters,
              int beyond)
      : stack_(lattice_stack(array, media)),
        media_(media),
        meters_(meters),
        beyond_(beyond),
        lines_(array.shape == FeatureArray::Shape::Line),
        // Between its planes light goes through the features as well as past them.
        nodes_(gloss_nodes(media, 2 * media.index * std::abs(array.terraces.back().height))) {}

  SpectrumPoint along_normal(double wavelength) const {
    SpectrumPoint out;
    out.wavelength = wavelength;
    out.transmitted = out.total = out.specular = 0;
    double cone = 0, all = 0;
    const double back =
        boundary_reflection(plain(media_.back), plain(media_.glass()), Polarisation::S, 0);
    const double leaves = OuterFace(media_.fill, Polarisation::S, 0)
                              .once(Column(media_, Polarisation::S, 0, wavelength).into_fill(back));
    // Round features on a square or hexagonal lattice look alike to both.
    const auto polarisations = lines_ ? 2u : 1u;
    for (unsigned k = 0; k < polarisations; ++k) {
      const Diffracted d = diffract(stack_, {wavelength, 0, kPolarisations[1 - k]}, beyond_);
      const double rest = (1 - back) / (1 - d.mirrored() * back) / polarisations * leaves;
      out.transmitted += (1 - meters_.inner_haze) * d.straight() * rest;
      out.total += d.transmission() * rest;
      for (const LatticeOrder& o : d.transmitted) {
        all += o.power;
        // Directions as in air, whatever fills the texture. Eq. optics.2, 8
        if (std::hypot(o.sx, o.sy) <= std::sin(meters_.cone)) cone += o.power;
        if (o.m == 0 && o.n == 0) out.specular += o.power;
      }
    }
    out.specular /= all;
    out.haze = 1 - (1 - meters_.inner_haze) * std::min(1.0, cone / all);
    return out;
  }

  double gloss_units(int degrees) const {
    const Receptor& receptor = gloss_meter(degrees);
    const double sine = std::sin(receptor.angle);
    std::vector<LatticeStack> planes{reversed(stack_)};
    if (lines_) planes.push_back(turned(planes.front()));
    double sum = 0;
    for (const PhotopicNode& node : nodes_) {
      for (const Polarisation p : kPolarisations) {
        double taken = 0;
        for (const LatticeStack& plane : planes) {
          const Diffracted d = diffract(plane, {node.wavelength, sine, p}, kBeyondOblique);
          for (const LatticeOrder& o : d.reflected)
            taken +=
                o.power * receptor.accepts(o.sx - sine, o.sy) / static_cast<double>(planes.size());
        }
        const OuterFace outer(media_.fill, p, sine);
        const double below = Column(media_, p, sine, node.wavelength).into_fill(0);
        sum += 0.5 * node.weight *
               (outer.reflected() * receptor.accepts(0, 0) + outer.twice(below) * taken);
      }
    }
    return 100 * sum / face_reflection(kGlossStandard, sine);
  }

 private:
  // Oblique light has half the symmetry: fewer orders, to a gloss unit.
  static constexpr int kBeyondOblique = 2;

  LatticeStack stack_;
  OpticalMedia media_;
  Meters meters_;
  int beyond_;
  bool lines_;
  std::vector<PhotopicNode> nodes_;  // of gloss
};

}  // namespace

LatticeStack lattice_stack(const FeatureArray& array, const OpticalMedia& media) {
  LatticeStack out;
  out.from = media.glass(), out.to = media.fill;
  const bool line = array.shape == FeatureArray::Shape::Line;
  const bool hexagonal = !line && array.lattice == Lattice::Hexagonal;
  out.cell = {line ? LatticeCell::Shape::Box : LatticeCell::Shape::Disc, array.period,
              hexagonal ? std::sqrt(3.0) * array.period : array.period, hexagonal};
  for (const Film& f : media.films)
    out.slices.push_back(flat_slice(permittivity(f.index, f.extinction), f.thickness));
  std::reverse(out.slices.begin(), out.slices.end());
  const Complex medium = permittivity(media.index, media.extinction),
                fill = permittivity(media.fill);
  const std::vector<double> planes = planes_of(array);
  if (media.cut_into_film())
    out.slices.push_back(flat_slice(medium, std::max(0.0, media.thickness + planes.front())));
  for (std::size_t k = 0; k + 1 < planes.size(); ++k) {
    const double width = width_at(array, 0.5 * (planes[k] + planes[k + 1]));
    out.slices.push_back({planes[k + 1] - planes[k], width, line ? array.period : width,
                          array.deep ? fill : medium, array.deep ? medium : fill});
  }
  return out;
}

Optics lattice_look(const FeatureArray& array, const OpticalMedia& media, const Meters& meters,
                    int beyond) {
  const LatticeFace face(array, media, meters, beyond);
  Optics out;
  out.regime = OpticsRegime::Rigorous;
  const Light light, followed = light.followed(media.path());
  for (const double wavelength : followed.wavelengths)
    out.spectrum.push_back(face.along_normal(wavelength));
  photopic_means(out, followed);
  gather_rows(out, light);
  out.gloss_20 = face.gloss_units(20);
  out.gloss = face.gloss_units(60);
  out.gloss_85 = face.gloss_units(85);
  if (meters.panel)
    out.sparkle = array_screen_of(array)->sparkle(media.index - media.fill, *meters.panel);
  const double depth = std::abs(array.terraces.back().height), most = most_slices(array);
  if (array.terraces.size() > 1 && depth > most * kStep * (1 + 1e-9)) {
    out.warning = fmt::format(
        "sloped walls {:.0f} nm deep are sliced every {:.0f} nm instead of {:.0f}: the rigorous "
        "look is rough; make the texture at most {:.0f} nm deep",
        1e9 * depth, 1e9 * depth / most, 1e9 * kStep, 1e9 * most * kStep);
  }
  return out;
}

}  // namespace papilla::optics
