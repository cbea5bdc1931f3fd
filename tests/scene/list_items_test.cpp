// Keys that stand in lists, which the reference shows by the name of their list alone.
#include <gtest/gtest.h>

#include <string>

#include "config/describe.h"
#include "scene/scene.h"
#include "scene/view.h"

namespace papilla::tests::list_items_test {
namespace {

// Key, kind, range, default and source, a line each.
template <class S>
std::string keys_of(const S& of) {
  std::string out;
  for (const FieldRow& row : field_rows(of))
    out += row.path + ": " + row.kind + ", " + row.range + ", " + row.default_value + ", " +
           row.source + " " + row.reference + "\n";
  return out;
}

TEST(ListItems, OfAFilmAreItsLayers) {
  EXPECT_EQ(keys_of(FilmDielectric{}),
            "material: a text, , SiO2, choice \n"
            "thickness: a length in nm, 0 to 1e7 nm, 500 nm, paper M3: 500 nm wet oxide\n"
            "permittivity: a number, 1 to 100000, 3.9, paper SiO2 3.9\n"
            "resistivity: a resistivity in ohm m, 0 to 1e30 ohm m, 1e14 ohm m, estimate thermal "
            "oxide\n"
            "strength: an electric field in V/um, 0 to 1000000 V/um, 1000 V/um, measured SiO2 1 "
            "GV/m at 50 "
            "nm (McPherson 2016)\n"
            "relaxation: a section, , , choice \n"
            "relaxation.law: one of none, debye, cole_cole, table, , none, choice \n"
            "relaxation.infinite: a number, 1 to 100000, 1, choice \n"
            "relaxation.time: a time in us, 0 to 1e12 us, 0 us, choice \n"
            "relaxation.alpha: a number, 0 to 0.99, 0, choice \n"
            "relaxation.frequency: a list, each a frequency in Hz, 1e-9 to 1e12 Hz, [], choice \n"
            "relaxation.permittivity: a list, each a number, 1 to 100000, [], choice \n"
            "relaxation.loss: a list, each a number, 0 to 100000, [], choice \n"
            "saturation_field: an electric field in V/um, 0 to 1000000 V/um, 0 V/um, choice \n"
            "process: one of surface, conformal, directional, planar, , surface, choice \n"
            "refractive_index: a number, 0 to 5, 0, choice \n"
            "extinction: a number, 0 to 5, 0, choice \n");
}

// A correlation lies between -1 and 1.
TEST(ListItems, OfAnUncertaintyAreItsNumbers) {
  EXPECT_EQ(keys_of(ParameterDeviation{"skin.rms", 0.1, {0.5}}),
            "parameter: a text, , skin.rms, choice \n"
            "deviation: a share in %, 0 to 300 %, 10 %, fit papilla calibrate\n"
            "correlation: a list, each a number, -1 to 1, [0.5], fit papilla calibrate\n");
}

// A file states thickness and index; a film that says nothing of it absorbs nothing.
TEST(ListItems, OfAFilmOfTheViewAreItsOpticalNumbers) {
  EXPECT_EQ(keys_of(ViewFilm{}),
            "material: a text, , , choice \n"
            "thickness: a length in nm, 0 to 100000 nm, 0 nm, choice \n"
            "refractive_index: a number, 1 to 5, 1, choice \n"
            "extinction: a number, 0 to 5, 0, choice \n");
  for (const FieldRow& row : field_rows(ViewFilm{}))
    EXPECT_EQ(row.required, row.path == "thickness" || row.path == "refractive_index") << row.path;
}

}  // namespace
}  // namespace papilla::tests::list_items_test
