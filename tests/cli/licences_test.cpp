// What `papilla --version --licences` says, beside what ldd says of the same files.
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "tests/cli/program.h"

namespace papilla::tests::licences_test {
namespace {

class Licences : public ::testing::Test {
 protected:
  const Workplace place_;
  const Outcome said_ = place_.run("--version --licences");
  const std::string linked_ =
      place_.shell("ldd '" PAPILLA_PROGRAM "' '" PAPILLA_BUILD_DIR "'/papilla_*.so").out;
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
TEST_F(Licences, SayUnderWhichTermsTheBinaryIsPassedOn) {
  const std::regex gpl("[^L]GPL-[0-9.]+-or-later(?! WITH)");
  EXPECT_EQ(std::regex_search(said_.out, gpl),
            said_.out.find("Who passes this build on does so under the GPL 3") != std::string::npos)
      << said_.out;
}

}  // namespace
}  // namespace papilla::tests::licences_test
