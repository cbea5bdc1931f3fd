// Hard cases of the program: hostile files, sizes and folders. Exit 0, 1 or 2 with a message, never
// a signal, nothing written outside the folder that was asked for, no half-written file.
#include <gtest/gtest.h>

#include <string_view>

#include "base/error.h"
#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "tests/cli/program.h"

namespace papilla::tests::program_slow_test {
namespace {

const std::string kHead = "schema_version = 1\n";
const std::string kStudy = PAPILLA_TEST_DATA "/study/tiny.toml";
const std::string kSolve =
    "solve contact --size '12 um' --pressure '15 kPa' --modulus '53 MPa' --json --height ";

std::string npy(const std::string& shape, const std::string& data) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
  header += shape;
  header += "), }\n";
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(header.size());
  out += '\0';
  out += header;
  out += data;
  return out;
}

std::string gsf(const std::string& keys) {
  std::string out = "Gwyddion Simple Field 1.0\n";
  out += keys;
  out.append(4 - out.size() % 4, '\0');
  out.append(64, '\0');
  return out;
}

// Before a command: in so much address space [kB]. None under the sanitizer, whose shadow exceeds
// it.
std::string within([[maybe_unused]] long kilobytes) {
#ifdef __SANITIZE_ADDRESS__
  return "";
#else
  return "ulimit -v " + std::to_string(kilobytes) + "; ";
#endif
}

void expect_refused(const Outcome& run, const std::string& message) {
  EXPECT_TRUE(run.status == 1 || run.status == 2) << run.status << run.err;
  EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
}

TEST(HostileSize, ABillionPixelsAndNegativeOnesAreRefusedBeforeAnythingIsAllocated) {
  const Workplace place;
  place.write("billion.npy", npy("31623, 31623", ""));
  place.write("negative.npy", npy("-4, 4", std::string(128, '\0')));
  place.write("none.npy", npy("0, 4", ""));
  place.write("wrap.npy", npy("4294967297, 4294967297", std::string(8, '\0')));
  place.write("short.npy", npy("16000, 16000", std::string(64, '\0')));
  place.write("billion.gsf", gsf("XRes = 1e9\nYRes = 1e9\nXReal = 1\nYReal = 1\n"));
  // In 2 GB of address space: what is refused must not have been allocated.
  for (const char* name :
       {"billion.npy", "negative.npy", "none.npy", "wrap.npy", "short.npy", "billion.gsf"}) {
    expect_refused(place.shell(within(2000000) + "'" PAPILLA_PROGRAM "' " + kSolve + name), name);
  }
  place.write("design.toml", kHead);
  for (const char* more : {"--pixels 100000", "--pixels 2000000000", "--pixels -5", "--pixels 0",
                           "--size '-1 um'", "--size '1e300 m'", "--size 'nan um'"}) {
    const Outcome run =
        place.shell(within(4000000) +
                    "timeout 20 '" PAPILLA_PROGRAM "' export design.toml --format npy --out out " +
                    std::string(more));
    EXPECT_TRUE(run.status == 1 || run.status == 2) << more << ": " << run.status << run.err;
    EXPECT_NE(run.err, "") << more;
  }
}

TEST(HostileSize, TheMemoryLimitIsNamed) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "no limit of address space under the sanitizer";
#endif
  const Workplace place;
  place.write("design.toml", kHead);
  expect_refused(
      place.shell(within(2000000) + "'" PAPILLA_PROGRAM
                                    "' export design.toml --format npy --pixels 16000 --out out"),
      "of memory");
}

TEST(HostileFile, NumbersThatAreNoneAreRefused) {
  const Workplace place;
  std::string nan(8, '\xff');
  std::string heights;
  for (int i = 0; i < 16; ++i) heights += i == 5 ? nan : std::string(8, '\0');
  place.write("nan.npy", npy("4, 4", heights));
  place.write("size.gsf", gsf("XRes = 2\nYRes = 2\nXReal = 1e308\nYReal = 1\nXYUnits = Gm\n"));
  place.write("half.gsf", gsf("XRes = 2.5\nYRes = 2\nXReal = 1\nYReal = 1\n"));
  for (const char* name : {"nan.npy", "size.gsf", "half.gsf"}) {
    expect_refused(place.run(kSolve + name), name);
  }
}

TEST(HostileFile, TruncatedAndChangedImagesAreReadOrRefused) {
  const Workplace place;
  const auto path = [&](const std::string& name) { return (place.path() / name).string(); };
  const Texture texture{HoleArray{}};
  const Heightmap h = generate(texture, patch_grid(texture, 32));
  write_exr(path("good.exr"), h, {});
  write_tiff16(path("good.tif"), h, Polarity::WhiteHigh, {});
  write_gsf(path("good.gsf"), h, {});
  write_npy(path("good.npy"), h);
  for (const char* ending : {".exr", ".tif", ".gsf", ".npy"}) {
    const std::string good = file_text(path(std::string("good") + ending));
    for (std::size_t k = 0; k < 200; ++k) {
      std::string changed = good;
      changed[k < 100 ? k : good.size() * k / 200] ^= '\xff';
      for (const std::string& bytes : {good.substr(0, good.size() * k / 200), changed}) {
        const std::string bad = place.write(std::string("bad") + ending, bytes);
        try {
          const Heightmap back = read_heightmap(path(bad), 12e-6);
          EXPECT_EQ(back.z.size(), back.grid.size());
        } catch (const InputError& e) {
          EXPECT_NE(std::string(e.what()), "");
        }
      }
    }
  }
}

TEST(HostileFile, AHeaderThatClaimsGigabytesIsRefusedBeforeTheyAreMade) {
  const Workplace place;
  const std::string path = (place.path() / "map.exr").string();
  const Texture texture{HoleArray{}};
  write_exr(path, generate(texture, patch_grid(texture, 32)), {});
  const std::string good = file_text(path);
  const std::string attribute("Gwy::XYUnit\0string\0", 19);
  const std::size_t at = good.find(attribute);
  ASSERT_NE(at, std::string::npos);
  for (const char* length : {"\xff\xff\xff\x7f", "\x00\x00\x00\x40", "\xff\xff\xff\xff"}) {
    std::string bad = good;
    bad.replace(at + attribute.size(), 4, std::string(length, 4));
    place.write("map.exr", bad);
    expect_refused(place.shell(within(900000) +
                               "timeout 20 '" PAPILLA_PROGRAM
                               "' solve contact --height map.exr --size '12 um' --pressure '15 "
                               "kPa' --modulus '53 MPa'"),
                   "the header is cut off");
  }
}

TEST(HostilePath, ABaseOutsideTheFoldersIsRefused) {
  const Workplace place;
  place.write("secret.toml", kHead);
  for (const char* base : {"../secret.toml", "inner/../../secret.toml", "/etc/passwd",
                           "link/secret.toml", "linked.toml"}) {
    place.write("project/bad.toml", kHead + "base = \"" + base + "\"\n");
    place.shell("ln -sfn .. project/link; ln -sf ../secret.toml project/linked.toml");
    expect_refused(place.shell("cd project && '" PAPILLA_PROGRAM "' explain bad.toml"), "base");
  }
}

TEST(HostileTarget, FoldersThatCannotBeWrittenAreRefused) {
  const Workplace place;
  place.write("design.toml", kHead);
  place.write("file", "not a folder");
  for (const char* target : {"file", "file/inner", "/proc/papilla", "/dev/full"}) {
    for (const std::string& command :
         {std::string("export design.toml --format npy --pixels 16 --out "),
          "optimize '" + kStudy + "' --evaluations 2 --out "}) {
      const Outcome run = place.run(command + target);
      EXPECT_TRUE(run.status == 1 || run.status == 2) << command << target << run.err;
      EXPECT_NE(run.err, "") << command << target;
    }
  }
  EXPECT_EQ(file_text(place.path() / "file"), "not a folder");
}

TEST(HostileTarget, AFullDiskIsSaidAndLeavesNoFile) {
  const Workplace place;
  place.write("design.toml", kHead);
  // Standard output to a full device.
  const Outcome printed = place.shell("'" PAPILLA_PROGRAM "' explain design.toml > /dev/full");
  EXPECT_EQ(printed.status, 1);
  EXPECT_NE(printed.err.find("cannot write"), std::string::npos) << printed.err;
  // No byte beyond a file-size limit, which stands for a full disk.
  for (const char* format : {"exr", "tiff", "gsf", "npy", "png", "stl"}) {
    const Outcome run =
        place.shell(std::string("trap '' XFSZ; ulimit -f 8; '" PAPILLA_PROGRAM
                                "' export design.toml --pixels 256 --out full --format ") +
                    format + (std::string_view(format) == "tiff" ? " --polarity white-high" : ""));
    const bool small = format == std::string("png") || format == std::string("exr");
    if (!small) {
      EXPECT_TRUE(run.status == 1 || run.status == 2) << format << run.status << run.err;
      EXPECT_NE(run.err, "") << format;
      EXPECT_EQ(place.shell("find full -name '*.part*' | grep .").status, 1) << format;
    }
    place.shell("rm -rf full");
  }
}

TEST(HostileToml, EveryKeyWrongIsReportedTogether) {
  const Workplace place;
  std::string text = kHead;
  for (const char* section : {"texture", "surface", "finger", "environment", "drive", "model",
                              "accuracy", "search", "objective", "population"}) {
    text += std::string("[").append(section).append("]\n");
    for (const char* key : {"period", "contact_angle", "load", "relative_humidity", "amplitude",
                            "preset", "level", "seed", "maximise", "fingers", "type", "state"}) {
      text += std::string(key) + " = { wrong = [1, \"nan um\", -1e400] }\n";
    }
  }
  place.write("bad.toml", text);
  const Outcome run = place.run("explain bad.toml");
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_GT(std::count(run.err.begin(), run.err.end(), '\n'), 0);
  std::string single = kHead;
  for (const char* section : {"texture", "surface", "finger", "environment", "drive"}) {
    single += std::string("[").append(section).append("]\n");
    for (const char* key : {"a", "b", "c"}) single += std::string(key) + " = 1\n";
  }
  place.write("unknown.toml", single);
  const Outcome unknown = place.run("explain unknown.toml");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_EQ(std::count(unknown.err.begin(), unknown.err.end(), '\n'), 15) << unknown.err;
}

TEST(HostileToml, DeepNestingAndLongLinesEnd) {
  const Workplace place;
  place.write("deep.toml", kHead + "a = " + std::string(100000, '[') + "\n");
  place.write("long.toml", kHead + "title = \"" + std::string(5000000, 'x') + "\"\n");
  std::string key = kHead;
  for (int i = 0; i < 20000; ++i) key += "a.";
  key += "a = 1\n";
  place.write("key.toml", key);
  for (const char* name : {"deep.toml", "long.toml", "key.toml"}) {
    const Outcome run =
        place.shell("timeout 20 '" PAPILLA_PROGRAM "' explain " + std::string(name));
    EXPECT_TRUE(run.status >= 0 && run.status <= 2) << name << run.status << run.err;
  }
}

}  // namespace
}  // namespace papilla::tests::program_slow_test
