// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/recording/base_clock.hpp"
#include "run/recording/csv_writer.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/recording_writer.hpp"
#include "tests/run/recording/scratch.hpp"

namespace isobar::test::test_bad_input {

using namespace isobar::recording;

namespace {

using test::count_of;
using test::Scratch;

const std::string kBarometerOnly = "version = 1\n[barometer]\nfile = \"b.csv\"\n";
constexpr std::int64_t kStart = 1'700'000'000'000'000'000;

std::string stamp(double seconds) {
  return std::to_string(kStart + static_cast<std::int64_t>(seconds * 1e9));
}

/// Reads a recording with this barometer file; returns its pressures.
std::vector<double> read_pressures(const Scratch& scratch, const std::string& csv,
                                   std::unique_ptr<RecordingReader>& reader) {
  scratch.write("recording.toml", kBarometerOnly);
  scratch.write("b.csv", csv);
  reader = std::make_unique<RecordingReader>(scratch.path());
  std::vector<double> pressures;
  Event event;
  while (reader->next(event)) {
    pressures.push_back(event.pressure.pressure_pa);
  }
  return pressures;
}

}  // namespace

TEST_CASE("Missing folders and files, and files of the wrong kind, are named in the error") {
  Scratch scratch;
  const auto fails = [](const std::filesystem::path& folder, const char* words) {
    CHECK_THROWS_WITH_AS(RecordingReader{folder}, doctest::Contains(words), DataError);
  };
  fails(scratch.path() / "absent", "no such folder");
  fails(scratch.path(), "holds no recording.toml");
  std::filesystem::create_directory(scratch.path() / "recording.toml");
  fails(scratch.path(), "recording.toml: is a folder");
  std::filesystem::remove(scratch.path() / "recording.toml");
  scratch.write("recording.toml", kBarometerOnly);
  fails(scratch.path() / "recording.toml", "is no folder");
  fails(scratch.path(), "b.csv: cannot be read: No such file");
  std::filesystem::create_directory(scratch.path() / "b.csv");
  fails(scratch.path(), "b.csv: is a folder");
  std::filesystem::remove(scratch.path() / "b.csv");
  scratch.write("b.csv", "");
  fails(scratch.path(), "b.csv:1: is empty");
  scratch.write("b.csv", "t_ns,temperature_c\n");
  fails(scratch.path(), "b.csv:1: column 'pressure_pa' is missing");
  scratch.write("recording.toml", "version = 1\n[lidar]\nmodel = \"VLP-16\"\nfile = \"b.csv\"\n");
  fails(scratch.path(), "b.csv: is no pcap file");
}

TEST_CASE("Every rule of recording.toml is checked with file, line and key; unknown keys only warn") {
  Scratch scratch;
  const auto fails = [&scratch](const std::string& text, const char* words) {
    scratch.write("recording.toml", text);
    std::vector<std::string> warnings;
    CHECK_THROWS_WITH_AS(read_manifest(scratch.path(), warnings), doctest::Contains(words), DataError);
  };
  fails("", "version: must be 1");
  fails("version = 2\n", "recording.toml:1: version: must be 1");
  fails("version = 8.3e+72\n", "recording.toml:1: version: must be 1");
  fails("version = 1\nversion = 1\n", "recording.toml:2: ");
  fails("version = 1\nimu = 3\n", "recording.toml:2: imu: must be a section");
  fails("version = 1\n[imu]\n", "recording.toml:2: imu.file: missing");
  fails("version = 1\n[imu]\nfile = \"../x\"\n", "recording.toml:3: imu.file: must lie inside");
  fails("version = 1\n[imu]\nfile = \"/etc/passwd\"\n", "must lie inside");
  fails("version = 1\n[imu]\nfile = \"i\"\nxyz_m = [0, 0]\n",
        "recording.toml:4: imu.xyz_m: must be three numbers");
  fails("version = 1\n[imu]\nfile = \"i\"\nxyz_m = [0, 0, nan]\n", "imu.xyz_m");
  fails("version = 1\n[imu]\nfile = \"i\"\nrpy_deg = [0, 0, 361]\n", "imu.rpy_deg");
  fails("version = 1\n[lidar]\nfile = \"l\"\n", "lidar.model");
  fails("version = 1\n[lidar]\nmodel = \"VLP-16\"\nfile = \"l\"\nport = 70000\n",
        "recording.toml:5: lidar.port");
  fails("version = 1\n[lidar]\nmodel = \"VLP-16\"\nfile = \"l\"\ninfo_port = -1\n",
        "recording.toml:5: lidar.info_port");
  fails("version = 1\n[lidar]\nmodel = \"VLP-16\"\nfile = \"l\"\nport = 8.3e+72\n",
        "recording.toml:5: lidar.port");
  std::string deep = "version = 1\na";
  for (int i = 0; i < 30'777; ++i) deep += ".a";
  fails(deep + " = 1\n", "recording.toml:2: a key has more than 16 parts");
  fails(std::string("version = 1\n\0", 13), "recording.toml:2: holds a NUL byte");
  fails("#" + std::string(1024 * 1024, 'x'), "recording.toml: is larger than 1024 KiB");
  scratch.write("recording.toml", "version = 1\ncolour = 3\n[imu]\nfile = \"i\"\nmood = 1\n[gps]\n");
  std::vector<std::string> warnings;
  read_manifest(scratch.path(), warnings);
  REQUIRE(warnings.size() == 3);
  CHECK(warnings[0].find("recording.toml:2: colour: unknown, ignored") != std::string::npos);
}

TEST_CASE("Columns may have any order; unknown columns and line ends do not matter") {
  Scratch scratch;
  std::unique_ptr<RecordingReader> reader;
  CHECK(read_pressures(scratch,
                       "\xEF\xBB\xBFtemperature_c, x ,pressure_pa,t_ns\r\n20,q,1.0e5," + stamp(0) +
                           "\r\n21,,\"100001\"," + stamp(1),
                       reader) == std::vector<double>{100'000, 100'001});
}

TEST_CASE("Broken rows are skipped and counted, the first one is quoted, and the good ones are kept") {
  Scratch scratch;
  std::unique_ptr<RecordingReader> reader;
  const std::string csv = "t_ns,pressure_pa,temperature_c\n" +                   //
                          stamp(0) + ",100000,20\n" +                            //
                          stamp(0.1) + ",nan,20\n" +                             //
                          stamp(0.2) + ",inf,20\n" +                             //
                          stamp(0.3) + ",100000\n" +                             //
                          stamp(0.4) + ",100000,20,7\n" +                        //
                          "soon,100000,20\n" + stamp(0.5) + ",1000 00,20\n" +    //
                          stamp(0.6) + ",0,20\n" +                               //
                          stamp(0.7) + ",1013,20\n" +                            //
                          stamp(0.8) + ",100000,2000\n" +                        //
                          "-5,100000,20\n\n" + std::string(9'000, 'x') + "\n" +  //
                          stamp(0.9) + ",100001,\n" +                            // no thermometer
                          stamp(1.0) + ",100002,nan\n";
  CHECK(read_pressures(scratch, csv, reader) == std::vector<double>{100'000, 100'001, 100'002});
  CHECK(count_of(*reader, "barometer: good rows") == 3);
  CHECK(count_of(*reader, "barometer: malformed rows") == 7);
  CHECK(count_of(*reader, "barometer: implausible rows") == 4);
  const auto counts = reader->counts();
  CHECK(test::find_count(counts, "barometer: malformed rows")
            ->first_message.find("b.csv:3: must be a finite number (is 'nan')") != std::string::npos);
  CHECK(test::find_count(counts, "barometer: implausible rows")
            ->first_message.find("b.csv:9: pressure must lie") != std::string::npos);
}

TEST_CASE("Absurd stamps are dropped, single or in a short run, also at the start; later samples are kept") {
  Scratch scratch;
  std::unique_ptr<RecordingReader> reader;
  const std::string head = "t_ns,pressure_pa,temperature_c\n";
  const auto row = [](const std::string& t, int p) { return t + "," + std::to_string(p) + ",20\n"; };
  std::string rows;
  std::vector<double> all;
  for (int i = 0; i < 100; ++i) {
    rows += row(stamp(i * 0.1), 50'000 + i);
    all.push_back(50'000 + i);
    if (i == 50) {
      rows += row("4000000000000000000", 90'000);  // 2096
    }
    if (i == 60) {
      rows += row("4000000000000000000", 90'000) + row("4000000000100000000", 90'000) +
              row("4000000000200000000", 90'000);
    }
    if (i == 70) {
      rows += row("0", 90'000);
    }
  }
  CHECK(read_pressures(scratch, head + rows, reader) == all);
  CHECK(count_of(*reader, "barometer: absurd stamps") == 5);
  CHECK(read_pressures(scratch, head + row("4000000000000000000", 90'000) + rows, reader) == all);
  CHECK(read_pressures(scratch, head + row("0", 90'000) + rows, reader) == all);
}

TEST_CASE("Gaps, repeated stamps and reordered rows keep every good row, in order") {
  Scratch scratch;
  std::unique_ptr<RecordingReader> reader;
  const auto row = [](double t, int p) { return stamp(t) + "," + std::to_string(p) + ",20\n"; };
  const std::string csv = "t_ns,pressure_pa,temperature_c\n" + row(0, 50'000) + row(0.1, 50'001) +
                          row(0.1, 50'001) + row(0.3, 50'003) + row(0.2, 50'002) + row(60, 50'004) +
                          row(60.1, 50'005);
  CHECK(read_pressures(scratch, csv, reader) ==
        std::vector<double>{50'000, 50'001, 50'002, 50'003, 50'004, 50'005});
  CHECK(count_of(*reader, "barometer: repeated stamps") == 1);
  CHECK(count_of(*reader, "barometer: reordered rows") == 1);
  CHECK(count_of(*reader, "barometer: gaps") == 1);
  CHECK(count_of(*reader, "barometer: absurd stamps") == 0);
}

TEST_CASE("A slow stream loses no row to the detection of clock steps") {
  Scratch scratch;
  std::unique_ptr<RecordingReader> reader;
  std::string csv = "t_ns,pressure_pa,temperature_c\n";
  for (int i = 0; i < 20; ++i) {
    csv += stamp(i * 60.0) + "," + std::to_string(50'000 + i) + ",20\n";
  }
  CHECK(read_pressures(scratch, csv, reader).size() == 20);
}

TEST_CASE("A clock that is set back in the middle loses no row") {
  Scratch scratch;
  std::unique_ptr<RecordingReader> reader;
  std::string csv = "t_ns,pressure_pa,temperature_c\n";
  for (int i = 0; i < 200; ++i) {
    csv += stamp(i < 100 ? i * 0.1 : i * 0.1 - 3'600) + "," + std::to_string(50'000 + i) + ",20\n";
  }
  CHECK(read_pressures(scratch, csv, reader).size() == 200);
  CHECK(count_of(*reader, "barometer: clock set back") == 1);
}

TEST_CASE("The base station's clock offset follows from the spans of the two files") {
  const std::int64_t s = 1'000'000'000;
  const StampSpan robot{1'000 * s, 1'600 * s};
  CHECK(tie_base_clock(robot, StampSpan{1'000 * s, 1'600 * s}).offset_ns == 0);
  CHECK(tie_base_clock(robot, StampSpan{900 * s, 1'650 * s}).offset_ns == 0);    // covers
  CHECK(tie_base_clock(robot, StampSpan{1'030 * s, 1'590 * s}).offset_ns == 0);  // overlaps
  CHECK(tie_base_clock(robot, StampSpan{1'100 * s, 1'700 * s}).offset_ns == -100 * s);
  // Both ends differ by two seconds: a clock offset. Only one end: a recorder started or stopped by hand.
  CHECK(tie_base_clock(robot, StampSpan{1'002 * s, 1'602 * s}).offset_ns == -2 * s);
  CHECK(tie_base_clock(robot, StampSpan{998 * s, 1'600 * s}).offset_ns == 0);
  CHECK(tie_base_clock(robot, StampSpan{5 * s, 607 * s}).offset_ns == 994 * s);  // a clock that starts at 0
  CHECK(tie_base_clock(robot, StampSpan{5'000 * s, 5'700 * s}).offset_ns == -4'050 * s);
  CHECK(tie_base_clock(robot, StampSpan{5 * s, 300 * s}).offset_ns == 995 * s);
  CHECK(tie_base_clock(std::nullopt, robot).offset_ns == 0);
}

TEST_CASE("Samples of an offset base station arrive on the robot's clock") {
  Scratch scratch;
  Manifest manifest;
  manifest.barometer = SensorEntry{"barometer.csv", {}};
  manifest.base_barometer = SensorEntry{"base_barometer.csv", {}};
  RecordingWriter writer(scratch.path(), manifest);
  const std::int64_t offset_ns = 86'400'123'456'789;
  for (int i = 0; i < 500; ++i) {
    writer.add_pressure({kStart + i * std::int64_t{100'000'000}, 100'000, 20});
    writer.add_base_pressure({kStart + i * std::int64_t{100'000'000} + offset_ns, 100'000, 20});
  }
  writer.close();
  RecordingReader reader(scratch.path());
  CHECK(reader.base_clock().offset_ns == -offset_ns);
  CHECK(reader.base_clock().reason.find("86400.1 s") != std::string::npos);
  Event event;
  int base = 0;
  while (reader.next(event)) {
    if (event.kind == EventKind::kBasePressure) {
      REQUIRE(event.stamp_ns == kStart + base++ * std::int64_t{100'000'000});
    }
  }
  CHECK(base == 500);
}

TEST_CASE("a text file on a full disk names the file and the reason, and nothing is written after its end") {
  recording::TextFile full("/dev/full");
  full.write(std::string(100'000, 'x'));  // more than the buffer: the write itself fails, not only the flush
  errno = 0;
  std::string message;
  try {
    full.close();
  } catch (const DataError& error) {
    message = error.what();
  }
  CHECK(message == "/dev/full: could not be written completely: " + std::string(std::strerror(ENOSPC)));
  CHECK_THROWS_AS(full.write("y"), DataError);
}

}  // namespace isobar::test::test_bad_input
