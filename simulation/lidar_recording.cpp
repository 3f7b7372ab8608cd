// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/lidar_recording.hpp"

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/errors.hpp"

namespace isobar::simulation {

namespace {

/// "os1.json" of an Ouster; empty for other makers.
std::string calibration_name(const LidarPlan& plan) {
  if (plan.maker != LidarMaker::kOuster) return {};
  return "os" + std::string(plan.name.substr(2)) + ".json";
}

/// The packets with the sensor's own angles, once a second, the first before the data.
class AnglePackets {
 public:
  AnglePackets(const LidarPlan& plan, recording::RecordingWriter& writer)
      : port_(plan.info_port), writer_(writer) {
    if (port_ != 0) bytes_ = encode_angles(plan);
  }
  void add_due(std::int64_t stamp_ns) {
    constexpr std::int64_t kPeriodNs = 1'000'000'000;
    if (bytes_.empty() || stamp_ns < next_ns_) return;
    writer_.add_packet(stamp_ns, bytes_, port_);
    next_ns_ = stamp_ns + kPeriodNs;
  }

 private:
  std::uint16_t port_;
  recording::RecordingWriter& writer_;
  PacketBytes bytes_;
  std::int64_t next_ns_ = 0;
};

}  // namespace

void describe_lidar(const LidarPlan& plan, recording::LidarEntry& entry) {
  entry.model = plan.name;
  entry.port = plan.port;
  entry.info_port = plan.info_port;
  entry.calibration_file = calibration_name(plan);
}

void write_lidar_calibration(const LidarPlan& plan, const std::filesystem::path& folder) {
  if (calibration_name(plan).empty()) return;
  const std::filesystem::path file = folder / calibration_name(plan);
  std::ofstream out(file, std::ios::binary);
  out << ouster_metadata(plan);
  out.close();
  if (!out) throw DataError(file.string() + ": cannot be written");
}

void write_lidar_packets(const LidarPlan& plan, const LidarModel& lidar, const LidarSpan& span,
                         const std::function<std::int64_t(double)>& stamp_ns,
                         recording::RecordingWriter& writer, const std::function<void(double)>& progress) {
  constexpr std::uint64_t kBatch = 512;
  const auto begin = static_cast<std::uint64_t>(span.start_s / lidar.packet_time_s(1));
  const auto total = static_cast<std::uint64_t>(span.end_s / lidar.packet_time_s(1));
  const std::uint64_t workers = std::clamp(std::thread::hardware_concurrency(), 1U, 16U);
  std::vector<ReceivedPacket> batch(kBatch);
  AnglePackets angles(plan, writer);
  for (std::uint64_t first = begin; first < total; first += kBatch) {
    const std::uint64_t count = std::min(kBatch, total - first);
    const auto work = [&](std::uint64_t worker) {
      for (std::uint64_t i = worker; i < count; i += workers) batch[i] = lidar.packet(first + i);
    };
    {
      std::vector<std::jthread> helpers;
      for (std::uint64_t worker = 1; worker < workers; ++worker) helpers.emplace_back(work, worker);
      work(0);
    }
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::int64_t received_ns = stamp_ns(batch[i].receive_time_s);
      angles.add_due(received_ns);
      writer.add_packet(received_ns, batch[i].bytes);
    }
    if (progress) progress(static_cast<double>(first + count) / static_cast<double>(total));
  }
}

}  // namespace isobar::simulation
