// SPDX-License-Identifier: BSD-3-Clause
// Calibration of a barometer: from the file into the settings.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "config/config_io.hpp"
#include "core/errors.hpp"
#include "tests/support/temporary_folder.hpp"

namespace isobar::test::test_compensation_settings {

namespace {

CompensationConfig calibrated() {
  CompensationConfig config;
  config.model = CompensationModel::kSimple;
  config.pressure_centre_pa = 98'765.4;
  config.pressure_scale_pa = 1.0 / 3.0 * 1e4;
  config.coefficients.assign(16, 0.0);
  config.coefficients[0] = 98'700.1;
  config.coefficients[1] = -47.3;
  config.coefficients[4] = 3'331.0;
  config.range = {96'000.0, 101'000.0, 0.5, 50.0};
  config.sigma_pa = 0.37;
  return config;
}

/// A folder with a calibration and a configuration that names it.
class Folder {
 public:
  [[nodiscard]] std::filesystem::path write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_.path() / file, std::ios::binary) << text;
    return folder_.path() / file;
  }

 private:
  test::TemporaryFolder folder_;
};

std::string text_of(const CompensationConfig& config) { return show_compensation(config, ""); }

}  // namespace

TEST_CASE("A calibration file keeps every bit of the numbers and every line of the comment") {
  const Folder folder;
  const std::string text = show_compensation(calibrated(), "One line.\nAnother, about the sensor.");
  CHECK(text.rfind("# One line.\n# Another, about the sensor.\n", 0) == 0);
  const CompensationConfig loaded = load_compensation(folder.write("a.toml", text));
  CHECK(text_of(loaded) == text_of(calibrated()));
  CHECK(loaded.coefficients == calibrated().coefficients);
  CHECK(loaded.pressure_scale_pa == calibrated().pressure_scale_pa);
}

TEST_CASE("compensation_file is found beside the configuration, and the calibration is shown as loaded") {
  const Folder folder;
  (void)folder.write("dps310.toml", text_of(calibrated()));
  const auto file = folder.write("isobar.toml", "[barometer]\ncompensation_file = \"dps310.toml\"\n");
  const Config config = load_config(file);
  CHECK(text_of(config.prior.compensation) == text_of(calibrated()));
  CHECK(config.prior.base_compensation.model == CompensationModel::kNone);
  const Config again = parse_config(show_config(config), "elsewhere.toml");
  CHECK(show_config(again) == show_config(config));
  CHECK(text_of(again.prior.compensation) == text_of(calibrated()));
  const Config base =
      load_config(folder.write("base.toml", "[base_barometer]\ncompensation_file = \"dps310.toml\"\n"));
  CHECK(text_of(base.prior.base_compensation) == text_of(calibrated()));
}

TEST_CASE("A calibration that cannot be used is refused with place, key and rule") {
  const Folder folder;
  const auto fails = [&](const std::string& calibration, const std::string& words) {
    CAPTURE(calibration);
    const auto file = folder.write("c.toml", calibration);
    CHECK_THROWS_WITH_AS(load_compensation(file), doctest::Contains(words.c_str()), ConfigError);
  };
  fails("[compensation]\nmodel = \"A_cubic\"\n",
        "c.toml:2:9: compensation.model: must be one of none, offset, A_p");
  fails("[compensation]\nmodel = \"A_p\"\n", "compensation.coefficients: must be sixteen numbers");
  fails("[compensation]\nsigma_pa = -1\n",
        "c.toml:2:12: compensation.sigma_pa: must be a number within 0 … 1000 Pa");
  fails("[compensation]\ncoefficients = [1, \"2\"]\n",
        "compensation.coefficients: must be a list of numbers");
  fails("[compensation]\ncoefficents = []\n", "did you mean compensation.coefficients?");
  fails("", "has no section [compensation]");
  fails("[compensation\n", "is no TOML");
  fails("[barometer]\n", "unknown key");
  CHECK_THROWS_WITH_AS(parse_config("[barometer]\ncompensation_file = \"/nonexistent\"\n", "c.toml"),
                       doctest::Contains("c.toml:2:21: barometer.compensation_file: must name a file"),
                       ConfigError);
  CHECK_THROWS_WITH_AS(parse_config("[barometer]\ncompensation_file = \"x.toml\"\n[barometer.compensation]\n"
                                    "model = \"offset\"\n",
                                    "c.toml"),
                       doctest::Contains("must be empty where"), ConfigError);
  CHECK_THROWS_WITH_AS(
      parse_config("[base_barometer.compensation]\nmodel = \"A_p\"\n", "c.toml"),
      doctest::Contains("c.toml:2:9: base_barometer.compensation.coefficients: must be sixteen"),
      ConfigError);
}

}  // namespace isobar::test::test_compensation_settings
