// SPDX-License-Identifier: BSD-3-Clause
// Fuzz target: a recording folder. The input is split at '\x01' into imu.csv, barometer.csv,
// base_barometer.csv, wheel.csv, lidar.pcap (without its file header), reference.tum and segments.csv.
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/errors.hpp"
#include "core/plausibility.hpp"
#include "run/recording/recording_reader.hpp"
#include "run/recording/reference.hpp"
#include "run/text/segments.hpp"

namespace {

using namespace isobar::recording;

const std::filesystem::path& scratch() {
  static const std::filesystem::path folder = [] {
    const char* base = std::filesystem::exists("/dev/shm") ? "/dev/shm" : "/tmp";
    const auto path = std::filesystem::path(base) / ("isobar-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    write_manifest(path, Manifest::with_all_sensors());
    std::atexit([] { std::filesystem::remove_all(scratch()); });
    return path;
  }();
  return folder;
}

void write(const char* name, std::string_view content) {
  std::ofstream(scratch() / name, std::ios::binary | std::ios::trunc) << content;
}

constexpr std::string_view kPcapHeader(
    "\xD4\xC3\xB2\xA1\x02\x00\x04\x00\0\0\0\0\0\0\0\0\xFF\xFF\0\0\x01\0\0\0", 24);

void check(const Event& event) {
  const bool good =
      event.kind == EventKind::kLidarPacket || isobar::implausible_stamp(event.stamp_ns) == nullptr;
  if (!good || (event.kind == EventKind::kPressure && isobar::implausibility(event.pressure) != nullptr) ||
      (event.kind == EventKind::kImu && isobar::implausibility(event.imu) != nullptr)) {
    std::abort();
  }
}

template <typename Work>
void tolerate(const Work& work) {
  try {
    work();
  } catch (const isobar::DataError&) {
    return;  // the specified refusal of a broken file
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  for (const char* name : {"imu.csv", "barometer.csv", "base_barometer.csv", "wheel.csv", "lidar.pcap",
                           "reference.tum", "segments.csv"}) {
    const auto end = std::string_view(name) == "lidar.pcap" ? rest.find(std::string_view("\x01\x01\x01\x01"))
                                                            : rest.find('\x01');
    const std::string_view part = rest.substr(0, end);
    write(name, std::string_view(name) == "lidar.pcap" ? std::string(kPcapHeader) + std::string(part)
                                                       : std::string(part));
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
  }
  tolerate([] {
    RecordingReader reader(scratch());
    Event event;
    while (reader.next(event)) {
      check(event);
    }
    if (!(reader.progress() >= 0.0) || reader.counts().size() > 100) {
      std::abort();
    }
  });
  tolerate([] { read_tum(scratch() / "reference.tum"); });
  tolerate([] { isobar::text::read_segments(isobar::text::TextLines(scratch() / "segments.csv")); });
  return 0;
}
