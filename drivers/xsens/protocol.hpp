// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "drivers/serial/imu_protocol.hpp"
#include "drivers/xsens/sample_reader.hpp"
#include "drivers/xsens/settings.hpp"
#include "drivers/xsens/stream_parser.hpp"

namespace isobar::xsens {

/// An output that the sensor is asked for.
struct Output {
  std::uint16_t id = 0;
  std::uint16_t rate_hz = 0;  ///< kEveryMessage: in every message
  const char* name = "";
  bool optional = false;  ///< not every model has it
};
inline constexpr std::uint16_t kEveryMessage = 0xFFFF;

/// Messages and dialogue of an Xsens MTi: configuration state, output configuration, measurement state. The
/// sensor keeps its output configuration in permanent memory, so that it is read first and written only if it
/// is another one; the acknowledgement holds what the sensor will send and is checked. The option flags are left
/// alone.
class Protocol final : public serial::ImuProtocol {
 public:
  explicit Protocol(const Settings& settings);

  void restart() noexcept override;
  std::span<std::uint8_t> room() noexcept override { return parser_.room(); }
  void filled(std::size_t count) noexcept override { parser_.filled(count); }
  void give_up_incomplete() noexcept override { parser_.give_up_incomplete(); }
  serial::ImuEvent next() noexcept override;
  [[nodiscard]] std::span<const std::uint8_t> command() const noexcept override;
  [[nodiscard]] const char* command_name() const noexcept override;
  [[nodiscard]] const char* refusal() const noexcept override { return refusal_.data(); }
  [[nodiscard]] const char* heard_instead() const noexcept override;
  [[nodiscard]] std::uint64_t corrupt() const noexcept override { return parser_.counters().corrupt; }
  [[nodiscard]] std::int64_t clock_period_ns() const noexcept override { return kClockPeriodNs; }

 private:
  enum class Stage : std::uint8_t { kGoToConfig, kReadOutput, kSetOutput, kGoToMeasurement, kDone };

  void take_data(const Frame& frame, serial::ImuEvent& event) noexcept;
  void take_error(const Frame& frame, serial::ImuEvent& event) noexcept;
  /// The data of a message are the outputs that are asked for, or those without the optional ones.
  [[nodiscard]] bool as_wanted(std::span<const std::uint8_t> held) const noexcept;
  serial::ImuEvent::Kind check_outputs(std::span<const std::uint8_t> held) noexcept;
  void answer(Stage of, Stage next, serial::ImuEvent& event) noexcept;

  bool configure_;
  std::vector<Output> outputs_;
  std::vector<std::uint8_t> go_to_config_, go_to_measurement_, read_output_;
  std::vector<std::uint8_t> set_output_, set_output_without_;  ///< all outputs, without the optional ones
  StreamParser parser_;
  SampleReader reader_;
  Stage stage_ = Stage::kDone;
  bool without_optional_ = false;
  std::array<char, 96> refusal_{};
  bool measured_ = false;         ///< since restart()
  std::array<char, 96> heard_{};  ///< what comes instead of measurements; empty: nothing
};

}  // namespace isobar::xsens
