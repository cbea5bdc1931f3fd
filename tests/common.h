// What nearly every test includes, compiled once (tests/CMakeLists.txt). Tests include what they
// use all the same.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <sstream>

#include "src/common.h"
