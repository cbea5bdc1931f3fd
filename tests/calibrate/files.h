// Files of a fit, in a folder of each test.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/rooms.h"
#include "calibrate/calibrate.h"
#include "claims/claim.h"
#include "tests/temporary.h"

namespace papilla::tests {

inline constexpr const char* kHeader =
    "design,relative_humidity,amplitude_V,frequency_Hz,load_N,F_off_N,F_off_sd_N,F_on_N,F_on_sd_"
    "N\n";

inline Calibration read(const std::string& path) { return read_calibration(path, m3_claim_ids()); }

class Calibrate : public testing::Test {
 protected:
  Calibrate() {
    folder_ =
        temporary("calibrate_") + testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }

  std::string folder_;
};

}  // namespace papilla::tests
