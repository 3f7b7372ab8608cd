// SPDX-License-Identifier: BSD-3-Clause
#include "tools/machine_survey.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <system_error>

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "drivers/bmp390/registers.hpp"
#include "drivers/bmp581/registers.hpp"
#include "drivers/bus/smbus.hpp"
#include "drivers/dps310/registers.hpp"
#include "drivers/icp20100/registers.hpp"
#include "drivers/ms5611/compensation.hpp"
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

/// A register that tells a barometer from others, at the addresses at which it can be.
struct Identification {
  BarometerSource barometer;
  std::array<std::uint8_t, 2> addresses;
  std::uint8_t id_register;
  std::uint8_t id;
};

constexpr std::array kIdentifications{
    Identification{BarometerSource::kDps310, {0x76, 0x77}, dps310::kProductId, dps310::kDps310Id},
    Identification{BarometerSource::kBmp390, {0x76, 0x77}, bmp390::kChipId, bmp390::kBmp390Id},
    Identification{BarometerSource::kBmp581, {0x46, 0x47}, bmp581::kChipId, bmp581::kBmp581Id},
    Identification{BarometerSource::kIcp20100, {0x63, 0x64}, icp20100::kDeviceId, icp20100::kIcp20100Id},
};
constexpr std::array<std::uint8_t, 2> kMs5611Addresses{0x76, 0x77};

/// The MS5611 has no identification but the checksum of its memory.
bool is_ms5611(RegisterBus& device) {
  ms5611::Prom prom{};
  if (!device.bursts()) return false;
  for (std::size_t word = 0; word < prom.size(); ++word) {
    std::array<std::uint8_t, 2> bytes{};
    if (device.read(static_cast<std::uint8_t>(ms5611::kReadProm + 2 * word), bytes) != 0) return false;
    prom[word] = static_cast<std::uint16_t>(bytes[0] << 8U | bytes[1]);
  }
  return ms5611::implausibility(prom) == nullptr;
}

bool is_one_of(const std::array<std::uint8_t, 2>& addresses, std::uint8_t address) {
  return std::find(addresses.begin(), addresses.end(), address) != addresses.end();
}

/// Addresses of all supported barometers, ascending.
std::vector<std::uint8_t> barometer_addresses() {
  std::set<std::uint8_t> addresses(kMs5611Addresses.begin(), kMs5611Addresses.end());
  for (const Identification& known : kIdentifications) {
    addresses.insert(known.addresses.begin(), known.addresses.end());
  }
  return {addresses.begin(), addresses.end()};
}

std::string address_text(std::uint8_t address) {
  std::ostringstream text;
  text << "0x" << std::hex << int{address};
  return text.str();
}

/// Identifies the device at an address of barometers. Reading a register changes no device.
void probe_i2c(const std::string& bus, Survey& survey) {
  for (const std::uint8_t address : barometer_addresses()) {
    SmbusDevice device(bus, address);
    std::uint8_t first = 0;
    int error = device.open();
    if (error == 0) error = device.read(0, {&first, 1});
    if (error == 0) {
      survey.i2c.push_back({bus, address, identify_barometer(device, address)});
    } else if (error == EBUSY) {
      survey.notes.push_back(bus + ": a kernel driver holds the device at address " + address_text(address));
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

BarometerSource identify_barometer(RegisterBus& device, std::uint8_t address) {
  for (const Identification& known : kIdentifications) {
    std::uint8_t id = 0;
    if (is_one_of(known.addresses, address) && device.read(known.id_register, {&id, 1}) == 0 &&
        id == known.id) {
      return known.barometer;
    }
  }
  if (is_one_of(kMs5611Addresses, address) && is_ms5611(device)) return BarometerSource::kMs5611;
  return BarometerSource::kNone;
}

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
