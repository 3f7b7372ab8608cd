// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/commands.hpp"
#include "tools/pressure_log.hpp"

namespace isobar::test::test_noise_command {

using isobar::files::read_text_file;
using isobar::files::write_text_file;
using isobar::test::TemporaryFolder;

namespace {

int noise(std::vector<std::string> words) {
  return isobar::test::exit_code(tools::add_noise_command, std::move(words));
}

/// A log of a DPS310 at rest for a minute, two rows per conversion.
std::string still_log(double factor) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0.0, 0.35);
  std::string text = "t_ns,pressure_pa,temperature_c\n";
  for (int i = 0; i < 60 * 32; ++i) {
    const double pressure = factor * (101'000.0 + normal(random));
    for (int repeat = 0; repeat < 2; ++repeat) {
      text += std::to_string(1'700'000'000'000'000'000 + 31'250'000LL * i + 10'000'000LL * repeat) + "," +
              std::to_string(pressure) + ",21.5\n";
    }
  }
  return text;
}

std::string message_of(const std::filesystem::path& file) {
  try {
    tools::read_new_values(file);
  } catch (const DataError& error) {
    return error.what();
  }
  return "";
}

std::ptrdiff_t says(const tools::PressureLog& log, const char* words) {
  return std::count_if(log.notes.begin(), log.notes.end(),
                       [words](const std::string& note) { return note.find(words) != std::string::npos; });
}

}  // namespace

TEST_CASE("isobar noise writes a report, and each mistake has its exit code") {
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  write_text_file(path("still.csv"), still_log(1.0));
  CHECK(noise({"noise", path("still.csv"), "--noise", "0.1", "--report", path("n.html")}) == 0);
  const std::string html = read_text_file(path("n.html"));
  CHECK(html.find("Allan deviation") != std::string::npos);
  CHECK(html.find("--noise 0.1") != std::string::npos);
  CHECK(noise({"noise", path("still.csv"), "--from", "5", "--to", "20"}) == 0);
  CHECK(noise({"noise"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--from", "59.9"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--lag", "1", "--noise", "0.1"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--lag", "-1"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--bandwidth", "17"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--noise", "0.5"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--columns", "t_ns"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--columns", "t_ns:hours,pressure_pa"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--columns", "t_ns,pressure_pa:fathom"}) == 64);
  CHECK(noise({"noise", path("still.csv"), "--columns", "time:s,pressure_pa"}) == 65);
  CHECK(noise({"noise", path("none.csv")}) == 65);
  write_text_file(path("empty.csv"), "t_ns,pressure_pa,temperature_c\n");
  CHECK(noise({"noise", path("empty.csv")}) == 65);
}

TEST_CASE("repeated and bad rows of a pressure log are left out and counted") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  write_text_file(file, still_log(1.0) + "1,2\n1700000000000000000,101000,20\n1800000000000000000,nan,20\n");
  const tools::PressureLog log = tools::read_new_values(file);
  CHECK(log.samples.size() == 60 * 32);
  CHECK(log.repeats == 60 * 32);
  // A header and 3840 good rows, then a row with two fields and a row without a number.
  CHECK(says(log, "no numbers: 2 (first: ") != 0);
  CHECK(says(log, ":3842: has 2 fields") != 0);
  CHECK(says(log, "goes back, while the rows after them go on: 1") != 0);
  CHECK(says(log, "repeat the value before: 1920") != 0);
  CHECK(log.samples[1].stamp_ns - log.samples[0].stamp_ns == 31'250'000);
  CHECK(log.samples[0].temperature_c == 21.5);
}

TEST_CASE("a unit that contradicts the column's name is refused; a unit found from the values is reported") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  write_text_file(file, still_log(0.01));
  CHECK(message_of(file).find("pressure is in Pa, as the column's name says, but its median") !=
        std::string::npos);
  std::string unnamed = still_log(0.001);
  unnamed.replace(unnamed.find("pressure_pa"), 11, "pressure");
  write_text_file(file, unnamed);
  CHECK(says(tools::read_new_values(file), "pressure is in kPa (column 'pressure', the only unit") != 0);
}

TEST_CASE("named columns and units give stamps exact to the nanosecond") {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "log.csv";
  const auto first_stamp = [&](const char* columns, const std::string& text) {
    write_text_file(file, text);
    return tools::read_new_values(file, tools::parse_columns(columns)).samples.front().stamp_ns;
  };
  CHECK(first_stamp("timestamp:us,p", "p,timestamp\n94212.4,1760456485602394\n") ==
        1'760'456'485'602'394'000);
  write_text_file(file, still_log(0.01));
  const auto in_hpa = tools::read_new_values(file, tools::parse_columns("t_ns,pressure_pa:hPa"));
  CHECK(in_hpa.samples.front().pressure_pa == doctest::Approx(101'000.0).epsilon(1e-4));
  CHECK(first_stamp("timestamp:s,p", "timestamp,p\n1760456485.602394123,94212.4\n") ==
        1'760'456'485'602'394'123);
  CHECK(first_stamp("Time (s):s,\xC3\xBCp", "\"Time (s)\",\xC3\xBCp\n1.25E0,94212.4\n") == 1'250'000'000);
}

}  // namespace isobar::test::test_noise_command
