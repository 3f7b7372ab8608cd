// SPDX-License-Identifier: BSD-3-Clause
// DDS readers of one base station, with its samples mapped to the robot clock.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/time/base_station_stream.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/samples.hpp"
#include "ipc/dds_config.hpp"
#include "ipc/shared_memory.hpp"

namespace isobar::bridge {

/// The newest temperatures, to be matched with pressures of the same sensor.
class Temperatures {
 public:
  /// @param source identifier of the base station
  void add(std::uint64_t source, const dds::TemperatureSample& sample) noexcept;
  /// Temperature of this source with the stamp nearest to `stamp_ns` [degrees C]; NaN: none within 2 s.
  /// A base station's isobar-dds sends both with the same stamp.
  [[nodiscard]] double at(std::uint64_t source, std::int64_t stamp_ns) const noexcept;

 private:
  struct Entry {
    std::uint64_t source = 0;  // 0: none
    dds::TemperatureSample sample;
  };
  std::array<Entry, 16> entries_{};
  std::size_t next_ = 0;
};

/// Readers of NAME/fluid_pressure and NAME/temperature. One thread.
class StationInput {
 public:
  /// @param station index: 0 first, 1 second base station
  /// @throws ServiceError when a DDS entity cannot be created
  StationInput(dds_entity_t participant, const dds::DdsConfig& config, const std::string& name,
               std::uint8_t station);

  /// Takes all waiting messages.
  /// @param now_ns robot clock
  /// @param system steps of this machine's system clock
  /// @param hand_on called with each accepted PressureSample, stamp on the robot clock
  /// @return number of implausible messages
  template <class HandOn>
  std::uint64_t take(std::int64_t now_ns, const SystemClockWatch& system, const HandOn& hand_on) {
    std::uint64_t refused = 0;
    pressure_.take([&](const dds::PressureMessage& message, dds_instance_handle_t writer) {
      PressureSample sample;
      if (dds::to_sample(message, sample) != nullptr) {
        ++refused;
        return;
      }
      refused += take_temperatures();
      sample.station = station_;
      sample.path = SamplePath::kDds;
      sample.temperature_c =
          temperatures_.at(source_of(pressure_.get(), writer, pressure_source_), sample.stamp_ns);
      if (stream_.check(writer, sample, now_ns, &system) == BaseVerdict::kAccepted) hand_on(sample);
    });
    note_departures();
    return refused;
  }

  /// Discards all waiting messages.
  /// @return number of pressure messages
  std::uint64_t drop();

  /// The reader to wait on: a temperature is used only with its pressure.
  [[nodiscard]] dds_entity_t pressure_reader() const noexcept { return pressure_.get(); }
  [[nodiscard]] dds_entity_t temperature_reader() const noexcept { return temperature_.get(); }
  [[nodiscard]] BaseStationStatus status() const noexcept { return stream_.status(); }

 private:
  /// Cached participant of a writer.
  struct Source {
    dds_instance_handle_t writer = 0;
    std::uint64_t participant = 0;
  };

  std::uint64_t take_temperatures();
  void note_departures() noexcept;
  /// The DDS participant of a writer. It links temperature and pressure of a base station, whose two writers
  /// belong to one participant.
  [[nodiscard]] static std::uint64_t source_of(dds_entity_t reader, dds_instance_handle_t writer,
                                               Source& last) noexcept;

  std::uint8_t station_;
  dds::Reader<dds::PressureMessage> pressure_;
  dds::Reader<dds::TemperatureMessage> temperature_;
  Source pressure_source_;
  Source temperature_source_;
  Temperatures temperatures_;
  BaseStationStream stream_;
};

}  // namespace isobar::bridge
