// SPDX-License-Identifier: BSD-3-Clause
#include "tools/machine_survey.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <system_error>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "drivers/bus/smbus.hpp"
#include "drivers/dps310/registers.hpp"
#include "drivers/udp/udp.hpp"
#include "drivers/velodyne/packet_format.hpp"

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

void survey_lidars(double seconds, Survey& survey) {
  constexpr std::uint16_t kDataPort = 2368;
  std::map<std::uint32_t, FoundLidar> found;  // by sender
  std::size_t others = 0;
  try {
    UdpReceiver receiver("0.0.0.0", kDataPort);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
      ReceivedDatagram datagram;
      if (receiver.receive(datagram, 100) != UdpReceiver::Status::kDatagram) continue;
      if (datagram.payload.size() != velodyne::kDataPacketBytes) {
        ++others;
        continue;
      }
      FoundLidar& lidar = found[datagram.sender.ipv4];
      lidar.packets_per_s += 1.0 / seconds;
      lidar.product_id = datagram.payload[velodyne::kProductIdOffset];
    }
    if (const std::string waits = receiver.waiting_for(); !waits.empty()) survey.notes.push_back(waits);
  } catch (const ServiceError& error) {
    survey.notes.emplace_back(error.what());
  }
  if (others > 0) survey.notes.push_back("UDP port 2368: datagrams that are no Velodyne packets");
  for (auto& [sender, lidar] : found) {
    lidar.sender = ipv4_text(sender);
    lidar.port = kDataPort;
    for (const char* model : {"VLP-16", "HDL-32E"}) {
      if (velodyne::product_name(lidar.product_id) == model) lidar.model = model;
    }
    survey.lidars.push_back(lidar);
  }
}

}  // namespace isobar::tools
