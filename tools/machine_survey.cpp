// SPDX-License-Identifier: BSD-3-Clause
#include "tools/machine_survey.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <system_error>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "drivers/bus/smbus.hpp"
#include "drivers/dps310/registers.hpp"
#include "drivers/lidar_models/lidar_models.hpp"
#include "drivers/udp/udp.hpp"

namespace isobar::tools {
namespace {

namespace fs = std::filesystem;

/// Names in a folder that begin with one of the prefixes, sorted; none where there is no such folder.
std::vector<std::string> names_in(const fs::path& folder, std::initializer_list<const char*> prefixes) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    const bool wanted = std::any_of(prefixes.begin(), prefixes.end(),
                                    [&name](const char* prefix) { return name.starts_with(prefix); });
    if (wanted) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return printable(line, 40);
}

/// Reads the product id at the addresses of the supported barometers. Reading a register changes no device.
void probe_i2c(const std::string& bus, Survey& survey) {
  for (const std::uint8_t address : {std::uint8_t{0x76}, std::uint8_t{0x77}}) {
    SmbusDevice device(bus, address);
    std::uint8_t id = 0;
    int error = device.open();
    if (error == 0) error = device.read(dps310::kProductId, {&id, 1});
    if (error == 0) {
      survey.i2c.push_back({bus, address, id == dps310::kDps310Id});
    } else if (error == EBUSY) {
      survey.notes.push_back(bus + ": a kernel driver holds the device at address " +
                             (address == 0x76 ? "0x76" : "0x77"));
    } else if (error != ENXIO && error != EREMOTEIO && error != EIO && error != ETIMEDOUT) {
      survey.notes.push_back(bus + ": cannot be probed: " + std::strerror(error));
      return;
    }
  }
}

void find_iio(const fs::path& devices, Survey& survey) {
  for (const std::string& name : names_in(devices, {"iio:device"})) {
    const fs::path folder = devices / name;
    std::error_code ignored;
    const bool has_pressure =
        fs::exists(folder / "in_pressure_input", ignored) || fs::exists(folder / "in_pressure_raw", ignored);
    if (has_pressure) survey.iio.push_back({folder.string(), first_line(folder / "name")});
  }
}

}  // namespace

void survey_devices(const fs::path& root, Survey& survey) {
  for (const std::string& name : names_in(root / "dev", {"i2c-"})) {
    survey.i2c_buses.push_back((root / "dev" / name).string());
    probe_i2c(survey.i2c_buses.back(), survey);
  }
  find_iio(root / "sys/bus/iio/devices", survey);
  // ttyS: the kernel makes nodes for ports that do not exist; those that do have a device in sysfs of type > 0.
  for (const std::string& name : names_in(root / "dev", {"ttyUSB", "ttyACM", "ttyAMA", "ttyS"})) {
    const std::string type = first_line(root / "sys/class/tty" / name / "type");
    if (name.starts_with("ttyS") && (type.empty() || type == "0")) continue;
    survey.serial.push_back((root / "dev" / name).string());
  }
  for (const std::string& name : names_in(root / "dev", {"gpiochip"})) {
    survey.gpio.push_back((root / "dev" / name).string());
  }
}

namespace {

/// A port at which lidars send, and the models that may.
class LidarPort {
 public:
  /// @throws ServiceError when this user may not use the port
  explicit LidarPort(std::uint16_t port) : receiver_("0.0.0.0", port), port_(port) {
    for (const LidarModel& model : lidar_models()) {
      if (model.port != port || model.needs_calibration) continue;
      LidarConfig config;
      config.model = model.name;
      decoders_.push_back(make_lidar_decoder(config));
    }
  }

  /// Takes the datagrams that wait, at most `timeout_ms` without one.
  void listen(int timeout_ms) {
    ReceivedDatagram datagram;
    while (receiver_.receive(datagram, timeout_ms) == UdpReceiver::Status::kDatagram) {
      timeout_ms = 0;
      Heard& heard = heard_[datagram.sender.ipv4];
      ++heard.packets;
      for (const auto& decoder : decoders_) {
        PacketColumns packet;
        const DecodeStatus status = decoder->read(datagram.payload, packet);
        if (status == DecodeStatus::kOk) ++heard.of_model[std::string(decoder->model())];
        if (status == DecodeStatus::kWrongModel) heard.mismatch = decoder->mismatch();
      }
    }
  }

  void report(double seconds, Survey& survey) const {
    if (const std::string waits = receiver_.waiting_for(); !waits.empty()) survey.notes.push_back(waits);
    for (const auto& [sender, heard] : heard_) {
      FoundLidar lidar;
      lidar.sender = ipv4_text(sender);
      lidar.port = port_;
      lidar.packets_per_s = static_cast<double>(heard.packets) / seconds;
      std::size_t most = 0;
      for (const auto& [model, packets] : heard.of_model) {
        if (packets > most) lidar.model = model;
        most = std::max(most, packets);
      }
      lidar.mismatch = heard.mismatch;
      if (lidar.model.empty() && lidar.mismatch.empty()) {
        survey.notes.push_back("UDP port " + std::to_string(port_) + ": datagrams of " + lidar.sender +
                               " that no driver knows");
      } else {
        survey.lidars.push_back(lidar);
      }
    }
  }

 private:
  struct Heard {
    std::size_t packets = 0;
    std::map<std::string, std::size_t> of_model;
    std::string mismatch;
  };
  UdpReceiver receiver_;
  std::uint16_t port_;
  std::vector<std::unique_ptr<LidarDecoder>> decoders_;
  std::map<std::uint32_t, Heard> heard_;  // by sender
};

}  // namespace

void survey_lidars(double seconds, Survey& survey) {
  std::set<std::uint16_t> numbers;
  for (const LidarModel& model : lidar_models()) numbers.insert(model.port);
  std::vector<std::unique_ptr<LidarPort>> ports;
  for (const std::uint16_t number : numbers) {
    try {
      ports.push_back(std::make_unique<LidarPort>(number));
    } catch (const ServiceError& error) {
      survey.notes.emplace_back(error.what());
    }
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!ports.empty() && std::chrono::steady_clock::now() < end) {
    for (const auto& port : ports) port->listen(10);
  }
  for (const auto& port : ports) port->report(seconds, survey);
}

}  // namespace isobar::tools
