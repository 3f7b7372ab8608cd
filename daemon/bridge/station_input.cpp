// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/station_input.hpp"

#include <limits>
#include <memory>

namespace isobar::bridge {
namespace {

/// Largest difference of stamps for which a temperature still applies to a pressure [ns]. A sensor's
/// temperature changes by less than 0.1 K in it.
constexpr std::int64_t kSameTimeNs = 2'000'000'000;

struct EndpointDeleter {
  void operator()(dds_builtintopic_endpoint_t* endpoint) const noexcept {
    dds_builtintopic_free_endpoint(endpoint);
  }
};

}  // namespace

void Temperatures::add(std::uint64_t source, const dds::TemperatureSample& sample) noexcept {
  entries_[next_] = {source, sample};
  next_ = (next_ + 1) % entries_.size();
}

double Temperatures::at(std::uint64_t source, std::int64_t stamp_ns) const noexcept {
  double nearest_c = std::numeric_limits<double>::quiet_NaN();
  std::int64_t nearest_ns = kSameTimeNs;
  for (const Entry& entry : entries_) {
    const std::int64_t apart_ns = std::abs(entry.sample.stamp_ns - stamp_ns);
    if (entry.source == 0 || entry.source != source || apart_ns > nearest_ns) continue;
    nearest_ns = apart_ns;
    nearest_c = entry.sample.temperature_c;
  }
  return nearest_c;
}

StationInput::StationInput(dds_entity_t participant, const dds::DdsConfig& config, const std::string& name,
                           std::uint8_t station)
    : station_(station),
      pressure_(participant, dds::topics::kBasePressure, name, config.topics.base_pressure,
                config.input_qos.base_pressure),
      temperature_(participant, dds::topics::kBaseTemperature, name, config.topics.base_temperature,
                   config.input_qos.base_pressure) {
  dds_set_status_mask(pressure_.get(), DDS_DATA_AVAILABLE_STATUS | DDS_SUBSCRIPTION_MATCHED_STATUS);
}

std::uint64_t StationInput::drop() {
  temperature_.take([](const dds::TemperatureMessage&) {});
  const int dropped = pressure_.take([](const dds::PressureMessage&) {});
  note_departures();
  return static_cast<std::uint64_t>(dropped);
}

std::uint64_t StationInput::take_temperatures() {
  std::uint64_t refused = 0;
  temperature_.take([&](const dds::TemperatureMessage& message, dds_instance_handle_t writer) {
    dds::TemperatureSample sample;
    if (dds::to_sample(message, sample) != nullptr) {
      ++refused;
      return;
    }
    temperatures_.add(source_of(temperature_.get(), writer, temperature_source_), sample);
  });
  return refused;
}

void StationInput::note_departures() noexcept {
  dds_subscription_matched_status_t change{};
  if (dds_get_subscription_matched_status(pressure_.get(), &change) != DDS_RETCODE_OK) return;
  const bool changed = change.total_count_change != 0 || change.current_count_change != 0;
  if (changed && !pressure_.is_matched(stream_.sender())) stream_.sender_gone(stream_.sender());
}

std::uint64_t StationInput::source_of(dds_entity_t reader, dds_instance_handle_t writer,
                                      Source& last) noexcept {
  if (last.writer == writer && last.participant != 0) return last.participant;
  const std::unique_ptr<dds_builtintopic_endpoint_t, EndpointDeleter> endpoint(
      dds_get_matched_publication_data(reader, writer));
  last = {writer, endpoint != nullptr ? endpoint->participant_instance_handle : 0};
  return last.participant;
}

}  // namespace isobar::bridge
