// What `papilla --version --licences` says, beside what ldd says of the same files.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "tests/cli/program.h"

namespace papilla::tests {
namespace {

class Licences : public ::testing::Test {
 protected:
  const Workplace place_;
  const Outcome said_ = place_.run("--version --licences");
  const std::string linked_ =
      place_.shell("ldd '" PAPILLA_PROGRAM "' '" PAPILLA_BUILD_DIR "/papilla_images.so'").out;
};

TEST_F(Licences, BeginWithTheVersionAndNameWhatIsLinked) {
  EXPECT_EQ(said_.status, 0) << said_.err;
  EXPECT_TRUE(said_.out.starts_with("papilla " PAPILLA_VERSION "\n")) << said_.out;
  for (const auto& [file, row] : {std::pair{"libfftw3.so", "| FFTW | GPL"},
                                  {"libpagmo.so", "| pagmo | GPL"},
                                  {"libcholmod.so", "| SuiteSparse: CHOLMOD | GPL"},
                                  {"libx264.so", "| x264"},
                                  {"libOpenEXR", "| OpenEXR"},
                                  {"libnlopt", "| NLopt"},
                                  {"libmpi.so", "| Open MPI"},
                                  {"libcrypto.so", "| OpenSSL"}}) {
    EXPECT_EQ(linked_.find(file) != std::string::npos, said_.out.find(row) != std::string::npos)
        << file << "\n"
        << said_.out;
  }
}

// The GPL with GCC's exception binds no program, and the LGPL is another licence.
TEST_F(Licences, APermissiveBuildHasNoneUnderTheGplAndNoneThatIsUnknown) {
  std::ifstream cache(PAPILLA_BUILD_DIR "/CMakeCache.txt");
  const std::string settings(std::istreambuf_iterator<char>(cache), {});
  ASSERT_NE(settings.find("PAPILLA_PERMISSIVE:BOOL="), std::string::npos);
  const bool permissive = settings.find("PAPILLA_PERMISSIVE:BOOL=ON") != std::string::npos;
  const std::regex gpl("[^L]GPL-[0-9.]+-or-later(?! WITH)");
  EXPECT_EQ(std::regex_search(said_.out, gpl), !permissive) << said_.out;
  EXPECT_EQ(said_.out.find("No library of this build is under the GPL") != std::string::npos,
            permissive);
  EXPECT_EQ(said_.out.find("have terms of their own") == std::string::npos, permissive);
}

}  // namespace
}  // namespace papilla::tests
