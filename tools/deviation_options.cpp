// SPDX-License-Identifier: BSD-3-Clause
#include "tools/deviation_options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "run/text/number_text.hpp"
#include "tools/number_option.hpp"

namespace isobar::tools {

using simulation::BarometerDeviation;
using simulation::Deviations;

namespace {

constexpr const char* kGroup = "Faults";

[[noreturn]] void refuse(const std::string& option, const std::string& text, const std::string& rule) {
  throw UsageError("--" + option + ": \"" + text + "\": " + rule);
}

/// Value of an option: words between colons.
class Words {
 public:
  Words(std::string option, std::string text) : option_(std::move(option)), text_(std::move(text)) {
    std::istringstream stream(text_);
    for (std::string word; std::getline(stream, word, ':');) words_.push_back(word);
  }

  [[noreturn]] void fail(const std::string& rule) const { refuse(option_, text_, rule); }
  void require_count(std::size_t least, std::size_t most, const std::string& form) const {
    if (words_.size() < least || words_.size() > most) fail("must be " + form);
  }
  [[nodiscard]] bool is(const char* word) const { return words_.front() == word; }
  [[nodiscard]] std::size_t count() const { return words_.size(); }
  [[nodiscard]] double number(std::size_t index) const {
    double value = 0.0;
    if (!text::parse_number(words_[index], value) || !std::isfinite(value)) {
      fail("\"" + words_[index] + "\" is no number");
    }
    return value;
  }
  [[nodiscard]] BarometerDeviation& barometer(Deviations& deviations) const {
    if (is("robot")) return deviations.robot;
    if (is("base")) return deviations.base;
    fail("must begin with robot: or base:");
  }
  /// RATE[:START_S[:DURATION_S]], from word `first` on.
  [[nodiscard]] simulation::Ramp ramp(std::size_t first) const {
    simulation::Ramp ramp;
    ramp.rate_pa_s = number(first);
    if (count() > first + 1) ramp.start_s = number(first + 1);
    if (count() > first + 2) ramp.duration_s = number(first + 2);
    if (ramp.start_s < 0.0) fail("the start must be 0 s or later");
    if (!(ramp.duration_s > 0.0)) fail("the duration must be more than 0 s");
    return ramp;
  }

  /// LOW_PA:HIGH_PA.
  [[nodiscard]] simulation::PressureRange range() const {
    require_count(2, 2, "LOW_PA:HIGH_PA");
    const simulation::PressureRange range{number(0), number(1)};
    if (range.low_pa < 0.0 || range.high_pa <= 0.0 || range.low_pa > range.high_pa) {
      fail("must be two pressures, 0 Pa or more, the lower one first");
    }
    return range;
  }

 private:
  std::string option_;
  std::string text_;
  std::vector<std::string> words_;
};

/// Adds an option whose values are taken one at a time, each time that it is given. The help names the form of
/// values with colons, which separate a type from its rule in the command line's own help.
void add(CLI::App& command, const std::string& name, const std::string& form, const std::string& help,
         const std::function<void(const Words&)>& take) {
  const bool has_parts = form.find(':') != std::string::npos;
  command
      .add_option_function<std::vector<std::string>>(
          "--" + name,
          [name, take](const std::vector<std::string>& values) {
            for (const std::string& value : values) take(Words(name, value));
          },
          has_parts ? help + ": " + form : help)
      ->allow_extra_args(false)
      ->type_name(has_parts ? "VALUE" : form)
      ->option_text(has_parts ? "VALUE" : form)
      ->group(kGroup);
}

void add_air_options(CLI::App& command, Deviations& deviations) {
  add(command, "common-ramp", "PA_S[:START_S[:DURATION_S]]", "pressure ramp of the air, at robot and base",
      [&deviations](const Words& words) {
        words.require_count(1, 3, "PA_S[:START_S[:DURATION_S]]");
        deviations.common_ramp = words.ramp(0);
      });
  add(command, "common-gust", "PA:HZ", "sinusoidal pressure of the air, amplitude and frequency, at both",
      [&deviations](const Words& words) {
        words.require_count(2, 2, "PA:HZ");
        deviations.common_gust = {words.number(0), words.number(1)};
        if (!(deviations.common_gust.frequency_hz > 0.0 && deviations.common_gust.frequency_hz <= 2.0)) {
          words.fail("the frequency must be more than 0 and at most 2 Hz");
        }
      });
}

void add_indoor_options(CLI::App& command, Deviations& deviations) {
  add(command, "zones", "LOW_PA:HIGH_PA", "offsets of the ventilated zones that the robot passes",
      [&deviations](const Words& words) { deviations.zones = words.range(); });
  add(command, "door-pulses", "LOW_PA:HIGH_PA", "peaks of the pressure pulses of doors",
      [&deviations](const Words& words) { deviations.pulses = words.range(); });
}

void add_barometer_options(CLI::App& command, Deviations& deviations) {
  add(command, "drift", "robot|base:PA_S[:START_S[:DURATION_S]]",
      "drift of a barometer; it keeps its offset afterwards", [&deviations](const Words& words) {
        words.require_count(2, 4, "robot|base:PA_S[:START_S[:DURATION_S]]");
        words.barometer(deviations).drift = words.ramp(1);
      });
  add(command, "thermometer", "robot|base:OFFSET_K", "error of a barometer's thermometer",
      [&deviations](const Words& words) {
        words.require_count(2, 2, "robot|base:OFFSET_K");
        words.barometer(deviations).thermometer_offset_k = words.number(1);
      });
  add(command, "base-silent", "START_S:DURATION_S", "the base station is out of reach",
      [&deviations](const Words& words) {
        words.require_count(2, 2, "START_S:DURATION_S");
        const double start_s = words.number(0);
        const double duration_s = words.number(1);
        if (start_s < 0.0) words.fail("the start must be 0 s or later");
        if (!(duration_s > 0.0)) words.fail("the duration must be more than 0 s");
        deviations.base_silent = simulation::TimeSpan{start_s, start_s + duration_s};
      });
  command
      .add_option("--base-rate", deviations.base_rate_hz, "samples a second that the base station sends [Hz]")
      ->check(number_within(0.01, Deviations::kFullBaseRateHz))
      ->capture_default_str()
      ->type_name("HZ")
      ->group(kGroup);
}

}  // namespace

void add_deviation_options(CLI::App& command, Deviations& deviations) {
  command
      .add_option(
          "--mount-error", deviations.mount_error_deg,
          "sd of further errors of roll, pitch and yaw of lidar and IMU [deg]; recording.toml keeps the "
          "mounts that the robot believes, its description the true ones")
      ->check(number_within(0.0, 20.0))
      ->type_name("DEG")
      ->group(kGroup);
  add_barometer_options(command, deviations);
  add_air_options(command, deviations);
  add_indoor_options(command, deviations);
  add(command, "airflow", "SHARE",
      "share of the dynamic pressure of driving at the robot's port, of either sign",
      [&deviations](const Words& words) {
        words.require_count(1, 1, "SHARE");
        deviations.airflow = words.number(0);
      });
  command
      .add_option("--start-at", deviations.start_at_s,
                  "leave out the run before this time [s]: the recording begins in motion")
      ->check(number_from_zero())
      ->type_name("S")
      ->group(kGroup);
  add(command, "without", "imu|wheels|base|barometer", "leaves a sensor out; may be given several times",
      [&deviations](const Words& words) {
        words.require_count(1, 1, "imu, wheels, base or barometer");
        if (words.is("imu")) {
          deviations.without_imu = true;
        } else if (words.is("wheels")) {
          deviations.without_wheels = true;
        } else if (words.is("base")) {
          deviations.without_base = true;
        } else if (words.is("barometer")) {
          deviations.without_barometer = true;
        } else {
          words.fail("must be imu, wheels, base or barometer");
        }
      });
}

}  // namespace isobar::tools
