#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "geometry/io/files.h"
#include "tests/temporary.h"

namespace papilla::tests::solve_test {
namespace {

std::string output(const std::string& arguments, int& status) {
  const std::string command = std::string(PAPILLA_PROGRAM) + " solve " + arguments + " 2>/dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  std::string out;
  std::array<char, 4096> buffer;
  while (std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) out.append(buffer.data(), n);
  status = WEXITSTATUS(pclose(pipe));
  return out;
}

TEST(SolveBridge, PrintsTheDocumentedJson) {
  int status = -1;
  const auto json = nlohmann::json::parse(
      output("bridge --volume '1 um3' --gap '300 nm' --theta1 '80 deg' --theta2 '50 deg' "
             "--surface-tension '1 N/m' --json",
             status));
  EXPECT_EQ(status, 0);
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["exists"], true);
  EXPECT_NEAR(json["energy"].get<double>(), -0.898608089813e-12, 1e-21);
  EXPECT_NEAR(json["force"].get<double>(), 12.0880249261e-6, 1e-14);
  EXPECT_NEAR(json["laplace_pressure"].get<double>(), -1.80787455249e6, 1e-2);
  EXPECT_NEAR(json["rupture_gap"].get<double>(), 0.99379858e-6, 1e-10);
  EXPECT_NEAR(json["equilibrium_gap"].get<double>(), 0.874631e-6, 1e-10);
}

TEST(SolveBridge, ARupturedBridgeIsNullAndWrongInputIsRefused) {
  int status = -1;
  const auto json =
      nlohmann::json::parse(output("bridge --volume '1 um3' --gap '1.2 um' --json", status));
  EXPECT_EQ(status, 0);
  EXPECT_EQ(json["exists"], false);
  EXPECT_TRUE(json["force"].is_null());
  output("bridge --volume '-1 um3' --json", status);
  EXPECT_EQ(status, 2);
  output("bridge --gap '100'", status);
  EXPECT_EQ(status, 2);
}

TEST(SolveDroplets, ReadsAGapAndDrawsAPicture) {
  Heightmap gap{{64, 64, 12e-6, 12e-6}, std::vector<double>(64 * 64, 100e-9)};
  const std::string folder = temporary("");
  write_gsf(folder + "gap.gsf", gap, {});
  int status = -1;
  const auto json = nlohmann::json::parse(output("droplets --gap " + folder +
                                                     "gap.gsf --volume '0.5 um3' --out " + folder +
                                                     "droplets.png --json",
                                                 status));
  EXPECT_EQ(status, 0);
  EXPECT_EQ(json["status"], "discs");
  double volume = 0;
  for (const auto& d : json["droplets"]) volume += d["volume"].get<double>();
  EXPECT_NEAR(volume, 0.5e-18, 1e-30);
  EXPECT_EQ(read_bytes(folder + "droplets.png").substr(1, 3), "PNG");
  output("droplets --gap " + folder + "gap.gsf --volume '-1 um3'", status);
  EXPECT_EQ(status, 2);
}

TEST(SolveDroplets, TakesGapAndWaterFromADesign) {
  int status = -1;
  const std::string design = PAPILLA_SOURCE_DIR "/designs/m3_samples/a3h600.toml";
  const auto json = nlohmann::json::parse(
      output("droplets --design " + design + " --humidity '55 %' --json", status));
  EXPECT_EQ(status, 0);
  EXPECT_NEAR(json["volume"].get<double>(), 1.84e-18, 1e-27);
  EXPECT_EQ(json["initial_droplets"], 184);
  EXPECT_GT(json["bridges"].get<int>(), 3);
  const auto ensemble = nlohmann::json::parse(
      output("droplets --design " + design + " --humidity '75 %' --placements 6 --json", status));
  EXPECT_EQ(status, 0);
  const auto& low = ensemble["volumes"][0];
  const auto& high = ensemble["volumes"][1];
  EXPECT_NEAR(high["volume"].get<double>(), 2 * low["volume"].get<double>(), 1e-24);
  EXPECT_GT(high["capillary_force"]["value"], low["capillary_force"]["value"]);
  EXPECT_GT(low["capillary_force"]["se"].get<double>(), 0);
  const auto pinned = nlohmann::json::parse(
      output("droplets --design " + design + " --humidity '55 %' --pin-edges --json", status));
  EXPECT_EQ(status, 0);
  EXPECT_NE(pinned["moves"], json["moves"]);
  output("droplets --design " + design + " --gap x.npy", status);
  EXPECT_EQ(status, 2);
  output("droplets --design " + design + " --humidity '130 %'", status);
  EXPECT_EQ(status, 2);
}

}  // namespace
}  // namespace papilla::tests::solve_test
