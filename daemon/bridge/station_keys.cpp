// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/station_keys.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "core/errors.hpp"
#include "ipc/keys/certificate.hpp"
#include "ipc/keys/key_folder.hpp"

namespace isobar::bridge {
namespace {

using namespace std::chrono_literals;  // NOLINT(google-build-using-namespace)
using ipc::HealthLevel;

constexpr auto kLookInterval = 2s;
/// A participant that is refused tries again every second.
constexpr auto kRefusalMemory = 10s;
constexpr std::int64_t kDayS = 86'400;
/// Warning before the end of validity: time for a visit to the machine.
constexpr std::int64_t kWarningDays = 30;

/// DDS topics of a base station.
std::vector<std::string> topics_of(const std::string& station, const dds::TopicNames& names) {
  return {dds::dds_name(dds::topics::kBasePressure, station, names.base_pressure),
          dds::dds_name(dds::topics::kBaseTemperature, station, names.base_temperature)};
}

template <std::size_t N>
void copy_text(const std::string& from, std::array<char, N>& to) {
  const std::size_t length = std::min(from.size(), N - 1);
  std::fill(std::copy_n(from.begin(), length, to.begin()), to.end(), '\0');
}

}  // namespace

StationKeys::StationKeys(const Settings& settings)
    : config_(settings.dds), folder_(settings.dds.keys_directory) {
  if (folder_.empty()) return;
  if (settings.is_base_station) {
    writes_ = topics_of(config_.base_station, config_.topics);
  } else if (config_.receive_base_pressure) {
    heard_.push_back(config_.base_station);
    if (!config_.second_base_station.empty()) heard_.push_back(config_.second_base_station);
  }
  for (const std::string& name : heard_) {
    for (std::string& topic : topics_of(name, config_.topics)) reads_.push_back(std::move(topic));
  }
}

void StationKeys::open(const dds::ParticipantSettings& network, const std::vector<dds::Interface>& interfaces,
                       dds_entity_t plain) {
  plain_ = plain;
  if (folder_.empty()) return;
  for (const std::string& name : heard_) {
    unsigned_.push_back(std::make_unique<dds::Reader<dds::PressureMessage>>(
        plain, dds::topics::kBasePressure, name, config_.topics.base_pressure));
  }
  fingerprint_ = keys::fingerprint(folder_);
  next_look_ = Clock::now() + kLookInterval;
  refused_by_library_ = false;
  if (std::string fault = fault_of_keys(); !fault.empty()) {
    note_fault(std::move(fault));
    return;
  }
  make_participant(network, interfaces);
}

void StationKeys::make_participant(const dds::ParticipantSettings& network,
                                   const std::vector<dds::Interface>& interfaces) {
  try {
    secure_ = std::make_unique<dds::SecureParticipant>(network, interfaces, folder_);
  } catch (const Error& error) {
    refused_by_library_ = true;
    note_fault(error.what());
    return;
  }
  fault_.clear();
  const std::string line = "base-station pressure is signed with the keys in " + folder_.string() +
                           ", valid until " + keys::date_of(until_s_);
  if (std::exchange(logged_, line) != line) spdlog::info("{}", line);
}

void StationKeys::close() noexcept {
  unsigned_.clear();
  secure_.reset();
  plain_ = 0;
}

void StationKeys::note_fault(std::string fault) {
  const std::string line =
      fault + (secure_ ? "; the keys read before stay in use"
                       : "; no base-station pressure until this is mended, looking every 2 s");
  fault_ = std::move(fault);
  if (std::exchange(logged_, line) != line) spdlog::error("{}", line);
}

std::string StationKeys::fault_of_keys() {
  try {
    const keys::KeyFolder keys = keys::check_key_folder(folder_, keys::unix_now_s());
    keys::check_permitted(keys, writes_, reads_);
    until_s_ = keys.until_s;
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

dds_entity_t StationKeys::participant() const noexcept {
  if (folder_.empty()) return plain_;
  return secure_ ? secure_->get() : 0;
}

void StationKeys::leave() noexcept {
  if (secure_) dds_delete(secure_->get());
}

bool StationKeys::is_due() {
  if (folder_.empty() || Clock::now() < next_look_) return false;
  next_look_ = Clock::now() + kLookInterval;
  if (secure_ && keys::unix_now_s() > until_s_) return true;
  std::string now = keys::fingerprint(folder_);
  const bool has_changed = now != fingerprint_;
  fingerprint_ = std::move(now);
  // Unchanged files can become valid when the clock is set; what the library refuses, only other files mend.
  if (!has_changed && (secure_ || refused_by_library_)) return false;
  std::string fault = fault_of_keys();
  if (fault.empty()) return true;
  note_fault(std::move(fault));
  return false;
}

void StationKeys::add_unsigned(KeyStatus& status) const {
  for (const auto& reader : unsigned_) {
    dds_subscription_matched_status_t matched{};
    if (dds_get_subscription_matched_status(reader->get(), &matched) != DDS_RETCODE_OK) continue;
    status.unsigned_now += matched.current_count;
    status.unsigned_total += matched.total_count;
    reader->take([](const dds::PressureMessage&) {});
  }
}

KeyStatus StationKeys::status() {
  KeyStatus status;
  status.signs = !folder_.empty();
  if (!status.signs) {
    copy_text("unsigned: dds.keys_directory is not set", status.text);
    return status;
  }
  add_unsigned(status);
  status.refused = dds::refused_members();
  if (std::exchange(refused_before_, status.refused.count) != status.refused.count)
    last_refusal_ = Clock::now();
  status.refused_lately = refused_before_ > 0 && Clock::now() - last_refusal_ < kRefusalMemory;
  const std::int64_t days = (until_s_ - keys::unix_now_s()) / kDayS;
  if (!fault_.empty()) {
    status.level = secure_ ? HealthLevel::kWarning : HealthLevel::kError;
    copy_text(fault_, status.text);
  } else {
    status.level = days < kWarningDays ? HealthLevel::kWarning : HealthLevel::kOk;
    copy_text("signed, with the keys in " + folder_.string() + ", valid until " + keys::date_of(until_s_),
              status.text);
  }
  status.days_left = secure_ ? static_cast<double>(days) : 0.0;
  return status;
}

}  // namespace isobar::bridge
