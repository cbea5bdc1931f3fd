#include "scene/view.h"

namespace papilla::scene {

void fields(FieldVisitor& v, ViewFilm& s) {
  v.text({"material", "name"}, s.material);
  v.number({"thickness", "nm", 0, 1e5, "thickness", Source::Choice, "", Presence::Required},
           s.thickness);
  v.number({"refractive_index", "", 1, 5, "refractive index n; indium tin oxide at 550 nm: 1.9",
            Source::Choice, "", Presence::Required},
           s.refractive_index);
  v.number({"extinction", "", 0, 5,
            "extinction coefficient k of n + i k: 0 is clear, indium tin oxide at 550 nm has 0.01"},
           s.extinction);
}

void fields(FieldVisitor& v, ViewPanel& s) {
  v.number({"subpixel_width", "um", 0, 1e4,
            "width of a subpixel; 0: no panel, no sparkle. 60 by 180 um is the reference of "
            "Corning's PPDr"},
           s.subpixel_width);
  v.number({"subpixel_height", "um", 0, 1e4, "height of a subpixel; 0: no panel"},
           s.subpixel_height);
  v.number({"glass", "mm", 0, 100, "thickness of the textured glass", Source::Estimate,
            "cover glass: 0.5 to 1.1 mm"},
           s.glass);
  v.number({"gap", "mm", 0, 100, "from the glass to the subpixels: glue or air, polariser, glass",
            Source::Estimate, "bonded panels: 0.3 to 1 mm"},
           s.gap);
  v.number({"gap_index", "", 1, 5, "refractive index of the gap: 1 air, 1.5 glue and glass"},
           s.gap_index);
  v.number({"distance", "mm", 10, 1e5, "of the eye"}, s.distance);
  v.number({"pupil", "mm", 0, 100, "diameter of the pupil, or of the camera's entrance",
            Source::Estimate, "an eye at a bright display: 3 to 5 mm"},
           s.pupil);
  v.number({"wavelength", "nm", 300, 1000, "light of the subpixels"}, s.wavelength);
}

void fields(FieldVisitor& v, View& s) {
  v.numbers(
      {"angles", "deg", 0, 70,
       "directions of view, from the normal; haze, transmittance and colour are means over them"},
      s.angles);
  v.number({"fill_index", "", 1, 5,
            "refractive index of what fills the texture when it is looked at: 1 air, 1.33 water, "
            "the glass's own: a matched fill; its outer face is flat, in air; friction is that of "
            "the open texture"},
           s.fill_index);
  v.number({"displacement", "nm", 0, 1e3,
            "standard deviation of a feature's place, each coordinate: haze of lattices below the "
            "periods of screens",
            Source::Estimate, "electron-beam and imprint masters: 2 to 10 nm"},
           s.displacement);
  v.number(
      {"diameter_scatter", "%", 0, 50,
       "standard deviation of diameters over their mean: haze of lattices below the periods of "
       "screens",
       Source::Estimate, "electron-beam and imprint masters: 1 to 4 %"},
      s.diameter_scatter);
  v.number({"cone", "deg", 0.1, 45,
            "light that leaves further than this from its direction is haze; some meters and "
            "sheets take 4 deg",
            Source::Paper, "ASTM D1003, ISO 14782"},
           s.cone);
  v.number({"inner_haze", "%", 0, 100,
            "haze of the plate itself: hard coat, film, glue; measured with both faces wetted"},
           s.inner_haze);
  v.number({"glass_index", "", 0, 5,
            "refractive index of the glass below the films; 0: surface.refractive_index"},
           s.glass_index);
  v.number({"back_index", "", 1, 5,
            "refractive index behind the glass: 1 air, the glass's own: bonded to the panel"},
           s.back_index);
  v.choice({"gloss_backing",
            "what gloss is read on. black: the back face sends nothing (ISO 2813); none: it "
            "reflects, as on the sheets of glass makers"},
           {"black", "none"}, s.gloss_backing);
  v.choice({"lattices",
            "theory of arrays. by_period: effective medium, rigorous, phase screen; rigorous: the "
            "Fourier modal method, of holes and pillars up to 2 um, of lines up to 6 um (seconds); "
            "scalar: never that one, periods "
            "between are refused"},
           {"by_period", "rigorous", "scalar"}, s.lattices);
  v.list({"films", "flat films between the dielectric and the glass, the one on the glass first"},
         s.films);
  v.section({"panel", "the display below"}, s.panel);
}

}  // namespace papilla::scene
