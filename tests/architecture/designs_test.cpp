#include <gtest/gtest.h>

#include "base/error.h"
#include "calibrate/calibrate.h"
#include "claims/claim.h"
#include "design/design.h"
#include "design/study.h"
#include "report/reference.h"
#include "scene/belief.h"
#include "tests/architecture/source_tree.h"

namespace papilla::tests::designs_test {
namespace {

TEST(Designs, AllRead) {
  int read = 0;
  for (const std::string& file : source_files({"designs"}, {".toml"})) {
    const std::string path = std::string(PAPILLA_SOURCE_DIR) + "/" + file;
    try {
      if (file.starts_with("designs/physics/")) {
        continue;  // cases of `papilla solve`, read by their own tests
      } else if (file.ends_with(".calibration.toml")) {
        read_calibration(path, m3_claim_ids());
      } else if (file.ends_with("/belief.toml")) {
        read_belief(path, read_finger(find_design("fingers/reference.toml")));
      } else if (file.starts_with("designs/fingers/")) {
        read_finger(path);
      } else {
        read_study(path);
      }
      ++read;
    } catch (const InputError& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GE(read, 13);
}

// Put over the finger of a design, each keeps what is its own: a belief is of a fit.
TEST(Designs, EveryFingerMayBePutOverThatOfADesign) {
  const std::string flat = find_design("m3_samples/flat.toml");
  for (const std::string& file : source_files({"designs/fingers"}, {".toml"})) {
    if (file.ends_with(".calibration.toml") || file.ends_with("/belief.toml")) continue;
    const std::string path = std::string(PAPILLA_SOURCE_DIR) + "/" + file;
    try {
      const Design design = read_design(flat, {"finger.base=\"" + path + "\""});
      EXPECT_EQ(design.finger.belief.empty(), read_finger(path).belief.empty()) << file;
      EXPECT_TRUE(belief_problems(design.finger).empty()) << file;
    } catch (const InputError& error) {
      ADD_FAILURE() << file << ": " << error.what();
    }
  }
}

TEST(Reference, PagesAreUpToDate) {
  for (const std::string& section : reference_sections()) {
    const std::string page =
        read_source(std::string(PAPILLA_SOURCE_DIR) + "/docs/reference/" + section + ".md");
    EXPECT_EQ(page, reference_section(section, ReferenceFormat::Markdown))
        << "docs/reference/" << section
        << ".md is out of date; write it again with: papilla describe --out docs/reference";
  }
}

}  // namespace
}  // namespace papilla::tests::designs_test
