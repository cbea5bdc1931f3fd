#include "scene/view.h"

namespace papilla::scene {

void fields(FieldVisitor& v, View& s) {
  v.numbers(
      {"angles", "deg", 0, 70,
       "directions of view, from the normal; haze, transmittance and colour are means over them"},
      s.angles);
  v.number({"fill_index", "", 1, 5,
            "refractive index of what fills the texture when it is looked at: 1 air, 1.33 water, "
            "the glass's own: a matched fill; friction is that of the open texture"},
           s.fill_index);
  v.number({"displacement", "nm", 0, 1e3,
            "standard deviation of a feature's place, each coordinate (haze below the wavelength)",
            Source::Estimate, "electron-beam and imprint masters: 2 to 10 nm"},
           s.displacement);
  v.number({"diameter_scatter", "%", 0, 50,
            "standard deviation of diameters over their mean (haze below the wavelength)",
            Source::Estimate, "electron-beam and imprint masters: 1 to 4 %"},
           s.diameter_scatter);
}

}  // namespace papilla::scene
