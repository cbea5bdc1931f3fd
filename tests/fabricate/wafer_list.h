// Lists of designs for test wafers, as a user writes them.
#pragma once

#include <string>

#include "base/rooms.h"
#include "tests/cli/program.h"

namespace papilla::tests {

inline std::string array_design(const std::string& type, const std::string& measures,
                                const std::string& more = "") {
  return "schema_version = 1\n[texture]\ntype = \"" + type + "\"\n" + measures + more +
         "[finger]\nbase = \"fingers/reference.toml\"\n";
}

// Four arrays of two depths.
inline std::string write_wafer_list(const Workplace& place, const std::string& sections) {
  const auto holes = [](const char* period, const char* diameter, const char* depth) {
    return array_design("hole_array", std::string("period = \"") + period + "\"\ndiameter = \"" +
                                          diameter + "\"\ndepth = \"" + depth +
                                          "\"\nwall_angle = \"85 deg\"\n");
  };
  place.write("h1.toml", holes("6 um", "3 um", "350 nm"));
  place.write("h2.toml", holes("6 um", "4 um", "350 nm"));
  place.write("h3.toml", holes("5 um", "2 um", "600 nm"));
  place.write("p1.toml",
              array_design("pillar_array",
                           "lattice = \"hexagonal\"\nperiod = \"5 um\"\ndiameter = "
                           "\"2.5 um\"\nheight = \"350 nm\"\nwall_angle = \"85 deg\"\n"));
  return place.write("list.toml", "schema_version = 1\n" + sections +
                                      "[[design]]\nname = \"H1\"\nfile = \"h1.toml\"\n"
                                      "[[design]]\nname = \"H2\"\nfile = \"h2.toml\"\n"
                                      "[[design]]\nname = \"H3\"\nfile = \"h3.toml\"\n"
                                      "[[design]]\nname = \"P1\"\nfile = \"p1.toml\"\n");
}

}  // namespace papilla::tests
